#include <algorithm>
#include <functional>
#include <string>
#include <system_error>

#include "core/format.h"
#include "core/replace_folder.h"
#include "core/temporary_file.h"

namespace vantage::internal::core {

namespace fs = std::filesystem;

fs::path without_slash(const fs::path& folder) { return folder.has_filename() ? folder : folder.parent_path(); }

std::string temporary_prefix(const fs::path& folder, const std::string& purpose) {
  constexpr std::size_t kMostBytes = 180;
  const std::string name = folder.filename().string();
  if (name.size() <= kMostBytes) return "." + name + ".vantage-" + purpose + "-";
  return fmt::format(".{}-{:016x}.vantage-{}-", name.substr(0, kMostBytes), std::hash<std::string>()(name), purpose);
}

bool is_named_so(const std::string& name, std::string_view prefix, std::string_view ending) {
  return name.size() == prefix.size() + kRandomCharacters + ending.size() && name.starts_with(prefix) &&
         name.ends_with(ending);
}

bool is_temporary_name(const std::string& name, std::string_view prefix) {
  return is_named_so(name, prefix, "") || is_named_so(name, prefix, kAside);
}

void TemporaryFile::remove_abandoned_ones() const {
  // Numbers are given from 0 on, so that those in use lie close together: further ones are looked at only behind
  // others.
  std::error_code unknown;
  for (int number = 0, last = kUsualNumbers; number < std::min(last, kMostNumbers); ++number) {
    for (const char* ending : {".tmp", ".old"}) {
      const fs::path candidate = numbered(number, ending);
      if (!fs::exists(fs::symlink_status(candidate, unknown))) continue;
      last = number + 1 + kUsualNumbers;
      remove_if_abandoned(candidate);
    }
  }
}

}  // namespace vantage::internal::core
