#include "tiles/tile_source.h"

#include <string_view>
#include <utility>

#include "common/input.h"
#include "io/mesh_source.h"
#include "tiles/http_source.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {
namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const int lower = c | 0x20;
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// "a%20b" is "a b".
std::string without_percents(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool is_code =
        uri[i] == '%' && i + 2 < uri.size() && hex_value(uri[i + 1]) >= 0 && hex_value(uri[i + 2]) >= 0;
    out += is_code ? static_cast<char>(hex_value(uri[i + 1]) * 16 + hex_value(uri[i + 2])) : uri[i];
    if (is_code) i += 2;
  }
  return out;
}

}  // namespace

FolderSource::FolderSource(std::filesystem::path tileset)
    : tileset_(std::move(tileset)), folder_(tileset_.has_parent_path() ? tileset_.parent_path() : ".") {}

std::string FolderSource::resolve(const std::string& base, const std::string& uri) const {
  const auto fail = [&](ErrorCode code, const std::string& problem, const std::string& fix) {
    throw Error(code, problem, shown(base), fix);
  };
  if (uri.find("://") < uri.find_first_of("/?#") || uri.starts_with("data:")) {
    fail(ErrorCode::mesh_unsupported,
         "the tileset refers to " + in_quotes(without_query(uri)) + ", which is no file beside it",
         "download the whole tileset");
  }
  const std::string path = without_percents(std::string_view{uri}.substr(0, uri.find_first_of("?#")));
  if (path.empty() || path.find('\0') != std::string::npos) {
    fail(ErrorCode::mesh_syntax, "the tileset refers to a file without a name", "export the tileset again");
  }
  // Others may have made the tileset: they shall not choose among all files of the machine.
  const std::filesystem::path joined = (std::filesystem::path(base).parent_path() / path).lexically_normal();
  if (joined.is_absolute() || joined.empty() || *joined.begin() == "..") {
    fail(ErrorCode::mesh_unsupported,
         "the tileset refers to " + in_quotes(without_query(uri)) + ", which is not below the folder of the tileset",
         "put all files of the tileset into its folder");
  }
  return joined.generic_string();
}

std::string FolderSource::read(const std::string& address, const core::ProgressReporter& progress) {
  const std::filesystem::path file = folder_ / address;
  std::error_code unknown;
  const std::filesystem::path real = std::filesystem::weakly_canonical(file, unknown),
                              base = std::filesystem::weakly_canonical(folder_, unknown);
  const bool is_below = std::mismatch(base.begin(), base.end(), real.begin(), real.end()).first == base.end();
  if (!is_below && address != root()) {
    throw Error(ErrorCode::mesh_unsupported, "a file of the tileset is a link out of the tileset's folder",
                file.string(), "put all files of the tileset into its folder");
  }
  return std::string(io::load_mesh_source(file, progress, core::ReadLimits::of_tiles()).bytes());
}

}  // namespace vantage::internal::tiles
