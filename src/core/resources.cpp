#include "common/resources.h"

#include <mutex>

namespace vantage {
namespace {

struct Place {
  std::mutex mutex;
  std::filesystem::path folder;
};

Place& place() {
  static Place the_place;
  return the_place;
}

}  // namespace

void set_resource_folder(const std::filesystem::path& folder) {
  const std::scoped_lock lock(place().mutex);
  place().folder = folder;
}

std::filesystem::path resource_folder() {
  const std::scoped_lock lock(place().mutex);
  return place().folder;
}

}  // namespace vantage
