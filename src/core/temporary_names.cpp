#include <functional>
#include <string>

#include "core/format.h"
#include "core/replace_folder.h"

namespace vantage::internal::core {

namespace fs = std::filesystem;

fs::path without_slash(const fs::path& folder) { return folder.has_filename() ? folder : folder.parent_path(); }

std::string temporary_prefix(const fs::path& folder, const std::string& purpose) {
  constexpr std::size_t kMostBytes = 180;
  const std::string name = folder.filename().string();
  if (name.size() <= kMostBytes) return "." + name + ".vantage-" + purpose + "-";
  return fmt::format(".{}-{:016x}.vantage-{}-", name.substr(0, kMostBytes), std::hash<std::string>()(name), purpose);
}

}  // namespace vantage::internal::core
