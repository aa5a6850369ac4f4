#include "cli/page_file.h"

#include <filesystem>
#include <vector>

#include "common/input.h"
#include "common/resources.h"
#include "live/file_bytes.h"
#include "live/page_text.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  check_readable(file, "the page");
  std::string page = live::bytes_of(file);
  live::check_page(page, file.string());
  return page;
}

}  // namespace

std::string read_page(const std::string& name, const std::string& given) {
  if (!given.empty()) return content_of(given);
  std::vector<fs::path> places;
  std::error_code error;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error) {
    const fs::path prefix = program.parent_path().parent_path();
    places = {prefix / "share/vantage/web" / name, prefix.parent_path() / "web/dist" / name};
  }
  if (!resource_folder().empty()) places.push_back(resource_folder() / "web" / name);
  for (const fs::path& place : places) {
    if (fs::is_regular_file(place, error)) return content_of(place);
  }
  throw Error(ErrorCode::page_missing, "the page is not installed", places.empty() ? name : places.front().string(),
              "run 'make web' in the source tree and 'make install', or name the page with --page FILE");
}

}  // namespace vantage::cli
