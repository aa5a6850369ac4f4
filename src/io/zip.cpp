// ZIP, PKWARE's APPNOTE 6.3: the directory at the end of the archive says where each file begins.
#include "io/zip.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <new>
#include <optional>

namespace vantage::internal::io {
namespace {

constexpr std::string_view kFile = "PK\3\4", kEntry = "PK\1\2", kEnd = "PK\5\6";
constexpr std::size_t kFileBytes = 30, kEntryBytes = 46, kEndBytes = 22, kLongestRemark = 65535;
// The number is in an extension for archives beyond 4 GB.
constexpr std::uint32_t kIsElsewhere = 0xFFFFFFFF, kCountIsElsewhere = 0xFFFF;
constexpr const char* kIsZip64 = "it is in the form of archives beyond 4 GB (zip64), which is not read";

[[noreturn]] void fail(const std::string& text) { throw ZipProblem(text); }

struct Entry {
  std::string_view name;
  std::uint32_t flags = 0, method = 0, checksum = 0, packed_bytes = 0, bytes = 0, offset = 0;
};

class Archive {
 public:
  explicit Archive(std::string_view bytes) : bytes_(bytes) { find_directory(); }

  /// What `visit` is true of first.
  template <typename Visit>
  std::optional<Entry> first(const Visit& visit) const {
    std::size_t at = directory_;
    for (std::uint32_t i = 0; i < entries_; ++i) {
      const Entry entry = entry_at(at);
      if (visit(entry.name)) return entry;
      at += kEntryBytes + number(at + 28, 2) + number(at + 30, 2) + number(at + 32, 2);
    }
    return std::nullopt;
  }

  /// The bytes of a file as they are in the archive.
  std::string_view packed(const Entry& entry) const {
    check(entry.offset, kFileBytes);
    if (bytes_.substr(entry.offset, 4) != kFile) fail("no file begins where its directory says");
    const std::size_t begin = entry.offset + kFileBytes + number(entry.offset + 26, 2) + number(entry.offset + 28, 2);
    check(begin, entry.packed_bytes);
    return bytes_.substr(begin, entry.packed_bytes);
  }

 private:
  void check(std::size_t from, std::size_t count) const {
    if (from > bytes_.size() || count > bytes_.size() - from) fail("it is cut off");
  }
  std::uint32_t number(std::size_t at, std::size_t count) const {
    check(at, count);
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes_[at + i]);
    return value;
  }

  void find_directory() {
    if (bytes_.size() < kEndBytes) fail("it is cut off");
    const std::size_t last = bytes_.size() - kEndBytes;
    const std::size_t first = last > kLongestRemark ? last - kLongestRemark : 0;
    for (std::size_t at = last + 1; at-- > first;) {
      if (bytes_.substr(at, 4) != kEnd) continue;
      entries_ = number(at + 10, 2);
      directory_ = number(at + 16, 4);
      if (entries_ == kCountIsElsewhere || directory_ == kIsElsewhere) fail(kIsZip64);
      return;
    }
    fail("it is cut off: it has no directory at its end");
  }

  Entry entry_at(std::size_t at) const {
    check(at, kEntryBytes);
    if (bytes_.substr(at, 4) != kEntry) fail("its directory is broken");
    const std::size_t name_bytes = number(at + 28, 2);
    check(at + kEntryBytes, name_bytes);
    Entry entry;
    entry.name = bytes_.substr(at + kEntryBytes, name_bytes);
    entry.flags = number(at + 8, 2);
    entry.method = number(at + 10, 2);
    entry.checksum = number(at + 16, 4);
    entry.packed_bytes = number(at + 20, 4);
    entry.bytes = number(at + 24, 4);
    entry.offset = number(at + 42, 4);
    return entry;
  }

  std::string_view bytes_;
  std::size_t directory_ = 0;
  std::uint32_t entries_ = 0;
};

bool ends_with(std::string_view name, std::string_view extension) {
  if (name.size() < extension.size()) return false;
  return std::equal(extension.begin(), extension.end(), name.end() - static_cast<std::ptrdiff_t>(extension.size()),
                    [](char a, char b) {
                      return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
                    });
}

/// No byte of a deflated stream makes more than this many.
constexpr std::uintmax_t kMostOfAByte = 1032;

/// Inflates a stream without a header. Exactly `size` bytes, or else it is broken: what is behind them is not made.
std::string inflated(std::string_view packed, std::size_t size) {
  if (size / kMostOfAByte > packed.size()) fail("its bytes are broken");
  std::string made(size, '\0');
  z_stream stream = {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(made.data());
  stream.avail_out = static_cast<uInt>(made.size());
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  const int status = inflate(&stream, Z_FINISH);
  const bool is_whole = status == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (!is_whole) fail("its bytes are broken");
  return made;
}

bool is_wanted(std::string_view name, std::string_view extension) {
  const bool is_of_macos = name.substr(0, 9) == "__MACOSX/";  // notes beside the files, with their names
  return ends_with(name, extension) && !is_of_macos;
}

}  // namespace

bool is_zip(std::string_view bytes) { return bytes.substr(0, 4) == kFile || bytes.substr(0, 4) == kEnd; }

std::string unzipped(std::string_view archive, std::string_view name, std::string_view extension,
                     std::uintmax_t most_bytes) {
  const Archive files(archive);
  std::optional<Entry> found = files.first([&](std::string_view other) { return other == name; });
  if (!found) found = files.first([&](std::string_view other) { return is_wanted(other, extension); });
  if (!found) throw ZipProblem("there is no " + std::string(extension) + " in it", ZipProblem::Kind::missing);
  if (found->flags & 1) fail("what it holds is encrypted");
  if (found->packed_bytes == kIsElsewhere || found->bytes == kIsElsewhere || found->offset == kIsElsewhere) {
    fail(kIsZip64);
  }
  if (found->bytes > most_bytes) {
    throw ZipProblem("the " + std::string(extension) + " in it is too large: " + std::to_string(found->bytes) +
                         " bytes, at most " + std::to_string(most_bytes),
                     ZipProblem::Kind::too_large);
  }
  const std::string_view packed = files.packed(*found);
  std::string made;
  if (found->method == 8) {
    made = inflated(packed, found->bytes);
  } else if (found->method == 0 && packed.size() == found->bytes) {
    made = packed;
  } else {
    fail(found->method == 0 ? "its bytes are broken" : "what it holds is packed by a method that cannot be read");
  }
  const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(made.data()), static_cast<uInt>(made.size()));
  if (checksum != found->checksum) fail("its bytes are broken");
  return made;
}

std::vector<std::string> names_in_zip(std::string_view archive, std::string_view extension) {
  std::vector<std::string> names;
  Archive(archive).first([&](std::string_view name) {
    if (is_wanted(name, extension)) names.emplace_back(name);
    return false;
  });
  return names;
}

std::string first_file_begins(std::string_view archive_begins, std::size_t most_bytes) {
  const auto number = [&](std::size_t at) {
    return static_cast<unsigned char>(archive_begins[at]) + 256U * static_cast<unsigned char>(archive_begins[at + 1]);
  };
  constexpr unsigned kDeflated = 8;
  if (archive_begins.size() < kFileBytes || archive_begins.substr(0, 4) != kFile || number(8) != kDeflated) return {};
  const std::size_t from = kFileBytes + number(26) + number(28);
  if (from >= archive_begins.size()) return {};
  const std::string_view packed = archive_begins.substr(from);
  std::string made(most_bytes, '\0');
  z_stream stream = {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(made.data());
  stream.avail_out = static_cast<uInt>(made.size());
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  inflate(&stream, Z_SYNC_FLUSH);
  made.resize(made.size() - stream.avail_out);
  inflateEnd(&stream);
  return made;
}

}  // namespace vantage::internal::io
