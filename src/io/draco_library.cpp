// Draco (Google, "Draco bitstream specification", version 2.2), by its library.
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <limits>

#include "io/mesh_codecs.h"

namespace vantage::internal::io {
namespace {

/// Points for a byte of data at most, beside 10,000. A flat lattice, which is the most regular mesh there is, has about
/// eight. So a small file cannot ask for more memory than it is worth.
constexpr std::uint64_t kPointsPerByte = 64, kFreePoints = 10'000;

[[noreturn]] void fail_broken(const std::string& why) { throw CodecProblem{"its Draco data is garbled: " + why}; }

struct DracoSize {
  std::uint64_t points = 0, triangles = 0;
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
  std::uint8_t traversal = 0;
  const bool is_edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
  if ((is_edgebreaker && !buffer.Decode(&traversal)) || !draco::DecodeVarint(&first, &buffer) ||
      !draco::DecodeVarint(&second, &buffer)) {
    fail_broken("it ends in its header");
  }
  return is_edgebreaker ? DracoSize{first, second} : DracoSize{second, first};
}

void check_size(const DracoSize& stated, std::size_t bytes, std::uint64_t most_triangles) {
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
                       std::uint64_t most_triangles) {
  draco::DecoderBuffer buffer;
  buffer.Init(data.data(), data.size());
  check_size(stated_size(buffer), data.size(), most_triangles);
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) fail_broken(decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

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
