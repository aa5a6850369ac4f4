// The bytes of an OpenStreetMap text, XML or JSON: unpacked, and bounded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace vantage::internal::osm {

/// gzip and bzip2 make up to some thousand and a million times of their bytes. A map that is packed has at most this
/// much text: 256 MiB, and 64 times the bytes of the file, four times what XML of maps gains.
constexpr std::uint64_t most_unpacked(std::uint64_t packed) { return (std::uint64_t{256} << 20U) + 64 * packed; }

inline constexpr const char* kMapFormats = "give an .osm, .osm.gz, .osm.bz2 or .osm.pbf file, or JSON of Overpass";

class TextInput {
 public:
  /// Throws std::system_error where the file cannot be opened.
  explicit TextInput(const std::filesystem::path& path);
  ~TextInput();
  TextInput(const TextInput&) = delete;
  TextInput& operator=(const TextInput&) = delete;

  /// The next part, some MiB at most; empty at the end. Throws RefusedInput for what is packed badly and for more than
  /// most_unpacked.
  std::string read();
  std::uint64_t offset() const;  ///< bytes of the file that were read
  std::uint64_t size() const;    ///< of the file

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Whether a text begins as a JSON object does.
bool is_json_object(std::string_view text);

/// The name of the first element of an XML or HTML text, "" where there is none; a DOCTYPE counts as html.
std::string_view root_element(std::string_view text);

/// What a file that is not ours looks like, for people. `root`: of its text.
std::string guess_content(std::string_view bytes, std::string_view root);

}  // namespace vantage::internal::osm
