#include "maps/osm/text_input.h"

#include <bzlib.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <system_error>

#include "maps/osm/refused_input.h"

namespace vantage::internal::osm {
namespace {

constexpr std::size_t kPart = std::size_t{1} << 20;  // bytes that are handed on at once

[[noreturn]] void refuse_packed(const char* method, const char* what, std::uint64_t at) {
  throw RefusedInput(ErrorCode::compression_broken, std::string("the ") + method + " data " + what,
                     "byte " + std::to_string(at), "download or export the map again");
}

/// The bytes of an open file, which it closes.
class RawFile {
 public:
  explicit RawFile(int descriptor) : descriptor_(descriptor) {
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0) size_ = static_cast<std::uint64_t>(status.st_size);
  }
  ~RawFile() { ::close(descriptor_); }
  RawFile(const RawFile&) = delete;
  RawFile& operator=(const RawFile&) = delete;

  /// Reads on when all that was read is used; false at the end of the file.
  bool fill() {
    if (used_ < part_.size()) return true;
    part_.resize(kPart);
    used_ = 0;
    ssize_t got = 0;
    do {
      got = ::read(descriptor_, part_.data(), part_.size());
    } while (got < 0 && errno == EINTR);
    if (got < 0) {
      throw RefusedInput(ErrorCode::file_unreadable, std::string("the file cannot be read: ") + std::strerror(errno),
                         "byte " + std::to_string(at()), "check the file and its disk");
    }
    part_.resize(static_cast<std::size_t>(got));
    read_ += part_.size();
    return got > 0;
  }

  std::string_view unused() const { return std::string_view{part_}.substr(used_); }
  void use(std::size_t count) { used_ += count; }
  std::uint64_t at() const { return read_ - (part_.size() - used_); }
  std::uint64_t size() const { return size_; }

 private:
  int descriptor_;
  std::uint64_t size_ = 0, read_ = 0;
  std::string part_;
  std::size_t used_ = 0;
};

/// What was packed into a file, in parts.
class Unpacker {
 public:
  Unpacker() = default;
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  virtual ~Unpacker() = default;
  /// At most kPart bytes; none at the end.
  virtual std::string read(RawFile& file) = 0;
};

class NotPacked final : public Unpacker {
 public:
  std::string read(RawFile& file) override {
    if (!file.fill()) return {};
    std::string part(file.unused());
    file.use(part.size());
    return part;
  }
};

/// One stream of gzip or bzip2 after the other: `Stream` has unpack(in, out), which tells what it used and whether the
/// stream ended, and starts anew by begin().
template <class Stream>
class Packed final : public Unpacker {
 public:
  std::string read(RawFile& file) override {
    std::string part(kPart, '\0');
    std::size_t filled = 0;
    while (filled < part.size()) {
      if (!file.fill()) {
        if (is_inside_) refuse_packed(Stream::kName, "ends too early", file.at());
        break;
      }
      if (!is_inside_) {
        if (file.unused().find_first_not_of('\0') == std::string_view::npos) {  // padding
          file.use(file.unused().size());
          continue;
        }
        stream_.begin();
        is_inside_ = true;
      }
      const auto [used, made, ended, good] = stream_.unpack(file.unused(), part.data() + filled, part.size() - filled);
      file.use(used);
      filled += made;
      if (!good) refuse_packed(Stream::kName, "is corrupt", file.at());
      if (ended) is_inside_ = false;
    }
    part.resize(filled);
    return part;
  }

 private:
  Stream stream_;
  bool is_inside_ = false;
};

struct Step {
  std::size_t used = 0, made = 0;
  bool ended = false, good = false;
};

class GzipStream {
 public:
  static constexpr const char* kName = "gzip";

  GzipStream() = default;
  ~GzipStream() {
    if (is_begun_) ::inflateEnd(&state_);
  }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  void begin() {
    constexpr int kGzipWindow = MAX_WBITS + 16;  // expect a gzip header
    const int result = is_begun_ ? ::inflateReset(&state_) : ::inflateInit2(&state_, kGzipWindow);
    if (result != Z_OK) throw std::bad_alloc();
    is_begun_ = true;
  }

  Step unpack(std::string_view in, char* out, std::size_t room) {
    state_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
    state_.avail_in = static_cast<uInt>(in.size());
    state_.next_out = reinterpret_cast<Bytef*>(out);
    state_.avail_out = static_cast<uInt>(room);
    const int result = ::inflate(&state_, Z_NO_FLUSH);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    return {in.size() - state_.avail_in, room - state_.avail_out, result == Z_STREAM_END,
            result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR};
  }

 private:
  z_stream state_{};
  bool is_begun_ = false;
};

class Bzip2Stream {
 public:
  static constexpr const char* kName = "bzip2";

  Bzip2Stream() = default;
  ~Bzip2Stream() { end(); }
  Bzip2Stream(const Bzip2Stream&) = delete;
  Bzip2Stream& operator=(const Bzip2Stream&) = delete;

  void begin() {
    end();
    state_ = {};
    if (::BZ2_bzDecompressInit(&state_, 0, 0) != BZ_OK) throw std::bad_alloc();
    is_begun_ = true;
  }

  Step unpack(std::string_view in, char* out, std::size_t room) {
    state_.next_in = const_cast<char*>(in.data());
    state_.avail_in = static_cast<unsigned>(in.size());
    state_.next_out = out;
    state_.avail_out = static_cast<unsigned>(room);
    const int result = ::BZ2_bzDecompress(&state_);
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    return {in.size() - state_.avail_in, room - state_.avail_out, result == BZ_STREAM_END,
            result == BZ_OK || result == BZ_STREAM_END};
  }

 private:
  void end() {
    if (is_begun_) ::BZ2_bzDecompressEnd(&state_);
    is_begun_ = false;
  }

  bz_stream state_{};
  bool is_begun_ = false;
};

std::unique_ptr<Unpacker> make_unpacker(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return std::make_unique<Packed<GzipStream>>();
  if (bytes.starts_with("BZh")) return std::make_unique<Packed<Bzip2Stream>>();
  return std::make_unique<NotPacked>();
}

int open_for_reading(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw std::system_error(errno, std::system_category());
  return descriptor;
}

}  // namespace

struct TextInput::Data {
  explicit Data(int descriptor) : file(descriptor) {}

  RawFile file;
  std::unique_ptr<Unpacker> unpacker;
  std::uint64_t unpacked = 0;
};

TextInput::TextInput(const std::filesystem::path& path) : data_(std::make_unique<Data>(open_for_reading(path))) {}
TextInput::~TextInput() = default;

std::string TextInput::read() {
  if (!data_->unpacker) {
    data_->file.fill();
    data_->unpacker = make_unpacker(data_->file.unused());
  }
  std::string part = data_->unpacker->read(data_->file);
  data_->unpacked += part.size();
  const std::uint64_t most = most_unpacked(size());
  if (data_->unpacked > most) {
    throw RefusedInput(ErrorCode::file_too_large,
                       "the map unpacks to more than " + std::to_string(most >> 20U) + " MiB", "",
                       "if it is right, unpack it first (gunzip, bunzip2) or convert it (osmium cat -o map.osm.pbf)");
  }
  return part;
}

std::uint64_t TextInput::offset() const { return data_->file.at(); }
std::uint64_t TextInput::size() const { return data_->file.size(); }

bool is_json_object(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  return start != std::string_view::npos && text[start] == '{';
}

std::string_view root_element(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  while (true) {
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos || text[start] != '<') return {};
    text.remove_prefix(start);
    const std::string_view end = text.starts_with("<!--") ? "-->" : text.starts_with("<?") ? "?>" : "";
    if (end.empty()) break;
    const std::size_t found = text.find(end);
    if (found == std::string_view::npos) return {};
    text.remove_prefix(found + end.size());
  }
  text.remove_prefix(1);
  return text.substr(0, text.find_first_of(" \t\r\n/>"));
}

std::string guess_content(std::string_view bytes, std::string_view root) {
  if (root == "html" || root == "HTML" || root == "!doctype") return "an HTML page";
  if (root == "!DOCTYPE")
    return bytes.find("DOCTYPE html") == std::string_view::npos ? "XML with a DOCTYPE" : "an HTML page";
  if (root == "osmChange") return "an OpenStreetMap change file";
  if (!root.empty()) return std::string("XML about <").append(root.substr(0, 40)).append(">");
  if (bytes.starts_with("\xff\xd8\xff")) return "a JPEG picture";
  if (bytes.starts_with("\x89PNG")) return "a PNG picture";
  if (bytes.starts_with("PK\x03\x04")) return "a ZIP archive";
  if (bytes.starts_with("\xff\xe0\x04o5m") || bytes.starts_with("\xff\xe0\x04o5c")) return "an o5m file";
  if (bytes.starts_with("%PDF")) return "a PDF";
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) return "a text in UTF-16";
  if (bytes.starts_with("{") || bytes.starts_with("[")) return "JSON";
  return "something else";
}

}  // namespace vantage::internal::osm
