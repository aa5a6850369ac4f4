#include "maps/osm/map_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <string_view>
#include <system_error>

#include "core/system_limits.h"
#include "maps/osm/pbf_file.h"
#include "maps/osm/refused_input.h"
#include "maps/osm/text_input.h"
#include "maps/osm/text_objects.h"
#include "vantage/error.h"

namespace vantage::internal::osm {
namespace {

constexpr std::string_view kAgain = "download or export the map again";

[[noreturn]] void fail(ErrorCode code, const std::string& where, std::string problem, std::string_view fix) {
  throw Error(code, std::move(problem), where, std::string(fix));
}

/// The first bytes of a regular file.
std::string first_bytes(const std::filesystem::path& path) {
  const std::string where = path.string();
  // O_NONBLOCK: opening a pipe that nobody writes to would wait for ever.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    if (errno == ENOENT) fail(ErrorCode::file_not_found, where, "the file does not exist", "correct the path");
    fail(ErrorCode::file_unreadable, where, std::string("the file cannot be opened: ") + std::strerror(errno),
         "check the path and the file's permissions");
  }
  struct stat status {};
  const bool known = ::fstat(descriptor, &status) == 0;
  std::array<char, 4096> bytes{};
  const ssize_t got = known && S_ISREG(status.st_mode) ? ::read(descriptor, bytes.data(), bytes.size()) : 0;
  ::close(descriptor);
  if (known && S_ISDIR(status.st_mode))
    fail(ErrorCode::not_a_file, where, "the file is a directory", "name a file in it");
  if (known && !S_ISREG(status.st_mode))
    fail(ErrorCode::not_a_file, where, "the file is not a regular file", "write it to a file first");
  if (!known || got < 0)
    fail(ErrorCode::file_unreadable, where, "the file cannot be read", "check the file and its disk");
  if (got == 0) fail(ErrorCode::file_empty, where, "the file is empty", kAgain);
  return {bytes.data(), static_cast<std::size_t>(got)};
}

bool is_pbf(std::string_view bytes) {
  // A length of four bytes, then the header's blob: field 1, the text "OSMHeader".
  return bytes.size() >= 15 && bytes.substr(4, 11) == "\x0a\x09OSMHeader";
}

/// Why reading stopped, from what was thrown.
[[noreturn]] void explain(const MapFile& file) {
  const std::string where = file.path.string();
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const RefusedInput& refused) {
    fail(refused.code, refused.place.empty() ? where : where + ", " + refused.place, refused.what(), refused.fix);
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::out_of_memory, where, "the file does not fit into memory, or is garbled",
         "cut it to the part that is needed");
  } catch (const std::system_error& error) {  // of threads and files: nothing that the map holds
    if (error.code() == std::errc::resource_unavailable_try_again) core::fail_for_threads();
    fail(ErrorCode::file_unreadable, where, std::string("the file cannot be read: ") + error.code().message(),
         "check the file and its disk");
  } catch (const std::exception& error) {
    fail(ErrorCode::map_syntax, where, std::string("the file is cut off or garbled: ") + error.what(), kAgain);
  }
}

}  // namespace

MapFile open_map_file(const std::filesystem::path& path) {
  const std::string bytes = first_bytes(path);
  if (bytes.starts_with("\x1f\x8b") || bytes.starts_with("BZh")) return {path, MapFormat::text};
  if (is_pbf(bytes)) return {path, MapFormat::pbf};
  const std::string_view root = root_element(bytes);
  if (root == "osm" || is_json_object(bytes)) return {path, MapFormat::text};
  std::string_view fix = kMapFormats;
  if (root == "osmChange") fix = "apply it to a map first (osmium apply-changes)";
  fail(ErrorCode::map_format_unknown, path.string(),
       "the file is not an OpenStreetMap file: it looks like " + guess_content(bytes, root), fix);
}

std::string read_objects(const MapFile& file, osmium::osm_entity_bits::type kinds,
                         const core::ProgressReporter& progress,
                         const std::function<void(const osmium::memory::Buffer&)>& handle) {
  try {
    if (file.format == MapFormat::text) return read_text(file.path, kinds, progress, handle);
    read_pbf(file.path, kinds, progress, handle);
    return {};
  } catch (...) {
    explain(file);
  }
}

}  // namespace vantage::internal::osm
