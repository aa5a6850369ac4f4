#include "maps/osm/pbf_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <osmium/io/detail/pbf_decoder.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "maps/osm/pbf_block.h"
#include "maps/osm/refused_input.h"

namespace vantage::internal::osm {
namespace {

namespace detail = osmium::io::detail;
namespace fs = std::filesystem;
using protozero::pbf_wire_type;
using protozero::tag_and_type;

constexpr std::size_t kMostBlobs = 64;                             // read at once, to be unpacked on all threads
constexpr std::uint64_t kMostInflated = std::uint64_t{32} << 20U;  // of these together, if not of a single one

[[noreturn]] void refuse(ErrorCode code, const std::string& problem, std::uint64_t at, const std::string& fix) {
  throw RefusedInput(code, problem, "the block at byte " + std::to_string(at), fix);
}

/// What libosmium calls a blob: a part of the file that is compressed as one.
struct Blob {
  std::uint64_t at = 0;  ///< in the file
  std::string bytes;
  std::string inflated;  ///< the room that `block` lies in, if it was compressed
  std::string_view block;
  std::uint64_t unpacked = 0;
  osmium::memory::Buffer objects;
};

/// How large the blob says that it is when inflated; libosmium checks it against what comes out.
std::uint64_t inflated_size(const std::string& bytes) {
  protozero::pbf_message<detail::FileFormat::Blob> blob(bytes);
  std::uint64_t size = bytes.size();
  while (blob.next(detail::FileFormat::Blob::optional_int32_raw_size, pbf_wire_type::varint)) {
    size = std::max(size, static_cast<std::uint64_t>(std::max(0, blob.get_int32())));
  }
  return size;
}

class BlobFile {
 public:
  explicit BlobFile(const fs::path& path) : stream_(path, std::ios::binary), size_(fs::file_size(path)) {
    if (!stream_) throw osmium::pbf_error("the file cannot be opened");
  }

  std::uint64_t size() const { return size_; }
  std::uint64_t at() const { return at_; }

  /// False at the end of the file.
  bool read(Blob& blob, std::string_view type) {
    if (at_ == size_) return false;
    blob.at = at_;
    const std::string length = take(4);
    std::uint64_t header_size = 0;
    for (const char byte : length) header_size = header_size << 8U | static_cast<unsigned char>(byte);
    if (header_size > static_cast<std::uint64_t>(detail::max_blob_header_size)) {
      throw osmium::pbf_error("invalid BlobHeader size");
    }
    blob.bytes = take(blob_size(take(header_size), type));
    return true;
  }

 private:
  std::string take(std::uint64_t count) {
    if (count > size_ - at_) throw osmium::pbf_error("truncated data (EOF encountered)");
    std::string bytes(count, '\0');
    if (!stream_.read(bytes.data(), static_cast<std::streamsize>(count))) {
      throw osmium::pbf_error("truncated data (EOF encountered)");
    }
    at_ += count;
    return bytes;
  }

  static std::uint64_t blob_size(const std::string& header_bytes, std::string_view type) {
    protozero::pbf_message<detail::FileFormat::BlobHeader> header(header_bytes);
    std::string_view found;
    std::int64_t size = 0;
    while (header.next()) {
      switch (header.tag_and_type()) {
        case tag_and_type(detail::FileFormat::BlobHeader::required_string_type, pbf_wire_type::length_delimited): {
          const protozero::data_view view = header.get_view();
          found = {view.data(), view.size()};
          break;
        }
        case tag_and_type(detail::FileFormat::BlobHeader::required_int32_datasize, pbf_wire_type::varint):
          size = header.get_int32();
          break;
        default:
          header.skip();
      }
    }
    if (found != type) throw osmium::pbf_error("blob does not have expected type (" + std::string(type) + ")");
    if (size <= 0 || static_cast<std::uint64_t>(size) > detail::max_uncompressed_blob_size) {
      throw osmium::pbf_error("invalid blob size");
    }
    return static_cast<std::uint64_t>(size);
  }

  std::ifstream stream_;
  std::uint64_t size_ = 0, at_ = 0;
};

class Reading {
 public:
  Reading(const fs::path& path, osmium::osm_entity_bits::type kinds, const core::ProgressReporter& progress,
          const std::function<void(const osmium::memory::Buffer&)>& handle)
      : file_(path), kinds_(kinds), progress_(progress), handle_(handle) {}

  void run() {
    Blob header;
    if (!file_.read(header, "OSMHeader")) throw osmium::pbf_error("the header is missing");
    detail::decode_header(header.bytes);  // which features it needs
    while (read_some()) {
      for_blobs(0, blobs_.size(), [](Blob& blob) { inflate(blob); });
      bound_all();
      decode_all();
      progress_.report(file_.at(), file_.size());
    }
  }

 private:
  bool read_some() {
    blobs_.clear();
    std::uint64_t inflated = 0;
    while (blobs_.size() < kMostBlobs && inflated < kMostInflated) {
      Blob blob;
      if (!file_.read(blob, "OSMData")) break;
      inflated += inflated_size(blob.bytes);
      blobs_.push_back(std::move(blob));
    }
    return !blobs_.empty();
  }

  template <class Step>
  void for_blobs(std::size_t begin, std::size_t end, const Step& step) {
    parallel::for_ranges(end - begin, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) step(blobs_[begin + i]);
    });
  }

  static void inflate(Blob& blob) {
    const protozero::data_view block = detail::decode_blob(blob.bytes, blob.inflated);
    blob.block = {block.data(), block.size()};
    try {
      blob.unpacked = unpacked_size(blob.block);
    } catch (const RefusedInput& refused) {
      refuse(refused.code, refused.what(), blob.at, refused.fix);
    }
  }

  void bound_all() {
    for (const Blob& blob : blobs_) {
      unpacked_ += blob.unpacked;
      if (blob.unpacked > kMostOfBlock) {
        refuse(ErrorCode::file_too_large,
               "a block of the map unpacks to more than " + std::to_string(kMostOfBlock >> 20U) + " MiB", blob.at,
               "if it is right, write it again in blocks of 8,000 objects: osmium cat -o out.osm.pbf");
      }
      if (unpacked_ > most_of_pbf(file_.size())) {
        refuse(ErrorCode::file_too_large,
               "the map unpacks to more than " + std::to_string(most_of_pbf(file_.size()) >> 20U) + " MiB", blob.at,
               "cut it to the part that is needed: osmium extract");
      }
    }
  }

  /// As many at a time as unpack to kMostOfBlock together.
  void decode_all() {
    for (std::size_t begin = 0, end = 0; begin < blobs_.size(); begin = end) {
      std::uint64_t together = 0;
      while (end < blobs_.size() && together + blobs_[end].unpacked <= kMostOfBlock) together += blobs_[end++].unpacked;
      for_blobs(begin, end, [this](Blob& blob) {
        detail::PBFPrimitiveBlockDecoder decoder({blob.block.data(), blob.block.size()}, kinds_,
                                                 osmium::io::read_meta::yes);
        blob.objects = decoder();
      });
      for (std::size_t i = begin; i < end; ++i) hand_over(blobs_[i]);
    }
  }

  /// A buffer that outgrew its first room holds the objects that came before in others, the first one innermost.
  void hand_over(Blob& blob) {
    while (blob.objects.has_nested_buffers()) handle_(*blob.objects.get_last_nested());
    handle_(blob.objects);
    blob = {};
  }

  BlobFile file_;
  osmium::osm_entity_bits::type kinds_;
  const core::ProgressReporter& progress_;
  const std::function<void(const osmium::memory::Buffer&)>& handle_;
  std::vector<Blob> blobs_;
  std::uint64_t unpacked_ = 0;
};

}  // namespace

void read_pbf(const fs::path& path, osmium::osm_entity_bits::type kinds, const core::ProgressReporter& progress,
              const std::function<void(const osmium::memory::Buffer&)>& handle) {
  Reading(path, kinds, progress, handle).run();
}

}  // namespace vantage::internal::osm
