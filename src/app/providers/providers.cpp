#include <atomic>

#include "app/providers/maps.h"
#include "app/providers/spheres.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

// Set before any constructor runs: an application may provide from one of its own.
constinit std::atomic<const MapProvider*> provided_maps = nullptr;
constinit std::atomic<const SpheresProvider*> provided_spheres = nullptr;

/// `library`: "maps"; `call`: the function that provides.
[[noreturn]] void throw_missing(const std::string& library, const std::string& call, const std::string& what,
                                const std::string& where) {
  throw Error(ErrorCode::component_missing,
              "this program lacks the library 'vantage_" + library + "', which " + what + " need", where,
              "link vantage::" + library + ", and call vantage::" + call + "() when the program starts");
}

}  // namespace

void provide(const MapProvider& provider) { provided_maps = &provider; }
void provide(const SpheresProvider& provider) { provided_spheres = &provider; }

const MapProvider& map_provider(const std::string& what, const std::string& where) {
  const MapProvider* provider = provided_maps;
  if (!provider) throw_missing("maps", "enable_maps", what, where);
  return *provider;
}

const SpheresProvider& spheres_provider(const std::string& what, const std::string& where) {
  const SpheresProvider* provider = provided_spheres;
  if (!provider) throw_missing("picture", "enable_spheres", what, where);
  return *provider;
}

}  // namespace vantage::internal::app
