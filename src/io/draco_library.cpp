// Draco (Google, "Draco bitstream specification", version 2.2), by its library.
#include <draco/compression/decode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "io/mesh_codecs.h"

namespace vantage::internal::io {
namespace {

/// Points for a byte of data at most, beside 10,000. A flat lattice, which is the most regular mesh there is, has about
/// eight. So a small file cannot ask for more memory than it is worth.
constexpr std::uint64_t kPointsPerByte = 64, kFreePoints = 10'000;

[[noreturn]] void fail_broken(const std::string& why) { throw CodecProblem{"its Draco data is garbled: " + why}; }

struct DracoSize {
  std::uint64_t points = 0, triangles = 0;
  std::uint64_t seams = 0;  ///< attributes that have a table of all corners of their own
  bool is_edgebreaker = false;
};

/// What the data says of its size, before anything is allocated for it (sections 4 and 5 of the specification).
DracoSize stated_size(draco::DecoderBuffer buffer) {
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) fail_broken("no header");
  if (header.encoder_type != draco::TRIANGULAR_MESH) throw CodecProblem{"its Draco data is a cloud of points"};
  if (header.version_major != 2 || header.version_minor < 2) {
    throw CodecProblem{"its Draco data is of version " + std::to_string(header.version_major) + "." +
                       std::to_string(header.version_minor) + ", and glTF asks for 2.2"};
  }
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor));
  if ((header.flags & METADATA_FLAG_MASK) != 0) {
    draco::GeometryMetadata ignored;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored)) fail_broken("its metadata");
  }
  std::uint32_t first = 0, second = 0;
  std::uint8_t traversal = 0, seams = 0;
  const bool is_edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
  if (!is_edgebreaker && header.encoder_method != draco::MESH_SEQUENTIAL_ENCODING) fail_broken("an unknown method");
  if ((is_edgebreaker && !buffer.Decode(&traversal)) || !draco::DecodeVarint(&first, &buffer) ||
      !draco::DecodeVarint(&second, &buffer) || (is_edgebreaker && !buffer.Decode(&seams))) {
    fail_broken("it ends in its header");
  }
  if (is_edgebreaker) return DracoSize{first, second, seams, true};
  return DracoSize{second, first, 0, false};
}

[[noreturn]] void fail_large(std::size_t bytes, std::uint64_t most) {
  throw CodecProblem{"its Draco data of " + std::to_string(bytes) + " bytes announces attributes of more than " +
                     std::to_string(most) + " bytes"};
}

void check_size(const DracoSize& stated, std::size_t bytes, std::uint64_t most_triangles, std::uint64_t most_bytes) {
  if (stated.triangles > most_triangles) {
    throw CodecProblem{"its Draco data holds " + std::to_string(stated.triangles) + " triangles, and its accessor " +
                       std::to_string(most_triangles)};
  }
  const std::uint64_t room = kFreePoints + kPointsPerByte * bytes;
  if (stated.points > room || stated.triangles > 2 * room) {
    throw CodecProblem{"its Draco data of " + std::to_string(bytes) + " bytes announces " +
                       std::to_string(stated.points) + " points and " + std::to_string(stated.triangles) +
                       " triangles"};
  }
  constexpr std::uint64_t kSeamBytes = 3 * sizeof(std::uint32_t);  // for each triangle
  if (stated.seams * stated.triangles * kSeamBytes > most_bytes) fail_large(bytes, most_bytes);
}

/// Decodes as `Base` does, but stops before the values of the attributes if these would take more than `most_bytes`.
/// How many points there are is known only then: where attributes have seams there are more than the header says.
template <class Base>
class BoundedDecoder final : public Base {
 public:
  explicit BoundedDecoder(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}
  bool is_too_large() const { return is_too_large_; }

 protected:
  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    std::uint64_t bytes = 0;
    for (std::int32_t i = 0; i < cloud.num_attributes() && bytes <= most_bytes_; ++i) {
      const draco::PointAttribute& attribute = *cloud.attribute(i);
      const std::uint64_t size = static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()));
      bytes += std::uint64_t{cloud.num_points()} * static_cast<std::uint64_t>(attribute.num_components()) * size;
    }
    is_too_large_ = bytes > most_bytes_;
    return !is_too_large_ && Base::DecodeAllAttributes();
  }

 private:
  std::uint64_t most_bytes_;
  bool is_too_large_ = false;
};

template <class Base>
void decode_bounded(draco::DecoderBuffer& buffer, std::size_t bytes, std::uint64_t most_bytes, draco::Mesh& mesh) {
  BoundedDecoder<Base> decoder(most_bytes);
  const draco::DecoderOptions options;
  const draco::Status status = decoder.Decode(options, &buffer, &mesh);
  if (decoder.is_too_large()) fail_large(bytes, most_bytes);
  if (!status.ok()) fail_broken(status.error_msg_string());
}

DracoMesh::Attribute values_of(const draco::Mesh& mesh, std::uint32_t id) {
  const draco::PointAttribute* const found = mesh.GetAttributeByUniqueId(id);
  if (!found) fail_broken("it has no attribute " + std::to_string(id));
  DracoMesh::Attribute attribute;
  attribute.components = found->num_components();
  const auto components = static_cast<std::size_t>(attribute.components);
  if (components == 0 || components > 4) fail_broken("an attribute of " + std::to_string(components) + " components");
  attribute.values.resize(mesh.num_points() * components);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex index = found->mapped_index(draco::PointIndex(i));
    if (index.value() >= found->size() ||
        !found->ConvertValue<double>(index, static_cast<std::int8_t>(components), &attribute.values[i * components])) {
      fail_broken("point " + std::to_string(i) + " has no value");
    }
  }
  return attribute;
}

}  // namespace

DracoMesh decode_draco(std::string_view data, const std::vector<std::uint32_t>& attributes,
                       std::uint64_t most_triangles, const core::ReadLimits& limits) {
  draco::DecoderBuffer buffer;
  buffer.Init(data.data(), data.size());
  const DracoSize stated = stated_size(buffer);
  const std::uint64_t most_bytes = limits.most_decompressed(data.size());
  check_size(stated, data.size(), most_triangles, most_bytes);
  const auto mesh = std::make_unique<draco::Mesh>();
  if (stated.is_edgebreaker) {
    decode_bounded<draco::MeshEdgebreakerDecoder>(buffer, data.size(), most_bytes, *mesh);
  } else {
    decode_bounded<draco::MeshSequentialDecoder>(buffer, data.size(), most_bytes, *mesh);
  }

  DracoMesh result;
  result.points = mesh->num_points();
  result.indices.reserve(std::size_t{3} * mesh->num_faces());
  for (std::uint32_t i = 0; i < mesh->num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(i))) {
      if (corner.value() >= result.points) fail_broken("a triangle has a corner that is not there");
      result.indices.push_back(corner.value());
    }
  }
  for (const std::uint32_t id : attributes) result.attributes.push_back(values_of(*mesh, id));
  return result;
}

}  // namespace vantage::internal::io
