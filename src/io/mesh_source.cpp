#include "io/mesh_source.h"

#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/system_files.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

constexpr std::string_view kGzipMagic = "\x1f\x8b";
constexpr std::size_t kChunk = std::size_t{1} << 22;  // bytes between two progress reports

std::filesystem::path without_gz(const std::filesystem::path& file) {
  return file.extension() == ".gz" ? file.stem() : file.filename();
}

[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& file, std::string problem, std::string fix) {
  throw Error(code, std::move(problem), file.string(), std::move(fix));
}

/// An open file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }

 private:
  int value_;
};

/// Zlib's state of one decompression.
class Inflater {
 public:
  Inflater() {
    constexpr int kGzipWindow = MAX_WBITS + 16;  // expect a gzip header
    if (inflateInit2(&stream, kGzipWindow) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream stream{};
};

}  // namespace

std::string MeshSource::stem() const { return without_gz(file_).stem().string(); }

std::string MeshSource::extension() const {
  std::string extension = without_gz(file_).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

void MeshSource::fail(ErrorCode code, std::string problem, std::string fix) const {
  io::fail(code, file_, std::move(problem), std::move(fix));
}

void MeshSource::fail_at_line(ErrorCode code, std::uint64_t line, std::string problem, std::string fix) const {
  throw Error(code, std::move(problem), file_.string() + ", line " + std::to_string(line), std::move(fix));
}

void MeshSource::fail_at_byte(ErrorCode code, std::uint64_t byte, std::string problem, std::string fix) const {
  throw Error(code, std::move(problem),
              file_.string() + ", byte " + std::to_string(byte) + (compressed_ ? " of the decompressed content" : ""),
              std::move(fix));
}

std::string read_file_bytes(const std::filesystem::path& file, const core::ProgressReporter& progress) {
  const Descriptor descriptor(core::open_to_read(file));
  if (descriptor.get() < 0) {
    if (errno == ENOENT) fail(ErrorCode::file_not_found, file, "the file does not exist", "correct the path");
    fail(ErrorCode::file_unreadable, file, std::string("the file cannot be opened: ") + std::strerror(errno),
         "check the path and the file's permissions");
  }
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) {
    fail(ErrorCode::file_unreadable, file, std::string("the file cannot be read: ") + std::strerror(errno),
         "check the file and its disk");
  }
  if (S_ISDIR(status.st_mode)) fail(ErrorCode::not_a_file, file, "the file is a directory", "name a file in it");
  if (!S_ISREG(status.st_mode))
    fail(ErrorCode::not_a_file, file, "the file is not a regular file", "write it to a file first");
  if (status.st_size == 0) fail(ErrorCode::file_empty, file, "the file is empty", "export the mesh again");

  progress.begin("read file");
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::read(descriptor.get(), bytes.data() + done, std::min(kChunk, bytes.size() - done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      fail(ErrorCode::file_unreadable, file, std::string("the file cannot be read: ") + std::strerror(errno),
           "check the file and its disk");
    }
    if (got == 0) {
      fail(ErrorCode::file_changed, file, "the file shrank while it was read",
           "wait until it is written, then try again");
    }
    done += static_cast<std::size_t>(got);
    progress.report(done, bytes.size());
  }
  return bytes;
}

std::string decompress_gzip(std::string_view compressed, const std::filesystem::path& file,
                            const core::ProgressReporter& progress, const core::ReadLimits& limits) {
  progress.begin("decompress");
  const std::string again = "compress the mesh again, or give it uncompressed";
  const std::uint64_t limit = limits.most_decompressed(compressed.size());
  Inflater inflater;
  z_stream& stream = inflater.stream;
  std::string out;
  std::size_t used = 0, filled = 0;
  while (true) {
    if (filled == out.size()) {
      const std::uint64_t wanted = std::max<std::uint64_t>({1 << 16, 3 * compressed.size(), 2 * filled});
      out.resize(std::min(wanted, limit + 1));  // the byte beyond the limit shows that there is more
    }
    const std::size_t in_size = std::min(kChunk, compressed.size() - used);
    const std::size_t out_size = std::min(kChunk, out.size() - filled);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data() + used));
    stream.avail_in = static_cast<uInt>(in_size);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + filled);
    stream.avail_out = static_cast<uInt>(out_size);
    const int result = inflate(&stream, Z_NO_FLUSH);
    used += in_size - stream.avail_in;
    filled += out_size - stream.avail_out;
    progress.report(used, compressed.size());

    if (filled > limit) {
      const bool is_large = limit == limits.decompressed_bytes;
      fail(ErrorCode::file_too_large, file,
           "the gzip data grows beyond " + std::to_string(limit) + " bytes" +
               (is_large ? "" : ", 64 MiB and 32 times those of the file"),
           is_large ? "decompress the file and cut the mesh to the part that is needed"
                    : "if it is right all the same, decompress it first (gunzip)");
    }
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result == Z_BUF_ERROR) fail(ErrorCode::compression_broken, file, "the gzip data ends too early", again);
    if (result != Z_OK && result != Z_STREAM_END) {
      fail(ErrorCode::compression_broken, file, "the gzip data is corrupt near byte " + std::to_string(used), again);
    }
    if (result != Z_STREAM_END) continue;
    // Another member may follow; zeros are padding.
    if (compressed.find_first_not_of('\0', used) == std::string_view::npos) break;
    inflateReset(&stream);
  }
  out.resize(filled);
  return out;
}

MeshSource load_mesh_source(const std::filesystem::path& file, const core::ProgressReporter& progress,
                            const core::ReadLimits& limits) {
  std::string bytes = read_file_bytes(file, progress);
  if (!bytes.starts_with(kGzipMagic)) return MeshSource(file, std::move(bytes));
  std::string plain = decompress_gzip(bytes, file, progress, limits);
  if (plain.empty()) fail(ErrorCode::file_empty, file, "the compressed file is empty", "export the mesh again");
  return MeshSource(file, std::move(plain), true);
}

}  // namespace vantage::internal::io
