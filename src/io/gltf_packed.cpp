// What is compressed inside of a glTF file: buffer views by EXT_meshopt_compression, primitives by
// KHR_draco_mesh_compression (Khronos Group). What the file also has uncompressed is read so.
#include <algorithm>

#include "io/gltf_document.h"

namespace vantage::internal::io::gltf {

const Json* Document::extension(const Json& object, const char* name) const {
  const auto extensions = object.find("extensions");
  if (extensions == object.end()) return nullptr;
  if (!extensions->is_object()) fail("\"extensions\" is not an object");
  const auto found = extensions->find(name);
  if (found == extensions->end()) return nullptr;
  if (!found->is_object()) fail(std::string("the extension ") + name + " is not an object");
  return &*found;
}

bool Document::is_required(std::string_view extension) const {
  const Json& required = array(root_, "extensionsRequired");
  return std::any_of(required.begin(), required.end(), [&](const Json& name) { return name == extension; });
}

void Document::fail_for_codec(const CodecProblem& problem, const std::string& where) const {
  if (problem.library_missing) {
    source_.fail(ErrorCode::component_missing, "the glTF file cannot be read: " + problem.text,
                 "install libdraco-dev and libmeshoptimizer-dev (Debian) and build vantage again, or export the mesh "
                 "without compression");
  }
  fail(where + ": " + problem.text);
}

std::string_view Document::unpacked_view(std::uint64_t index, const Json& packed) {
  if (const auto known = unpacked_views_.find(index); known != unpacked_views_.end()) return known->second;
  const std::string_view bytes = buffer(required_whole(packed, "buffer"));
  const std::uint64_t start = whole(packed, "byteOffset").value_or(0), length = required_whole(packed, "byteLength");
  const std::string name = "buffer view " + std::to_string(index);
  if (start + length > bytes.size()) fail(name + " goes beyond the end of its buffer");
  const MeshoptView described{required_whole(packed, "count"), required_whole(packed, "byteStride"),
                              text(packed, "mode"), text(packed, "filter")};
  try {
    std::string unpacked = decode_meshopt(bytes.substr(start, length), described, limits_);
    count_held(unpacked.size());
    buffer_bytes_ += unpacked.size();
    return unpacked_views_[index] = std::move(unpacked);
  } catch (const CodecProblem& problem) {
    fail_for_codec(problem, name);
  }
}

const DracoMesh& Document::unpacked_mesh(std::uint64_t view_index, const std::vector<std::uint32_t>& ids,
                                         std::uint64_t most_triangles) {
  const std::pair<std::uint64_t, std::vector<std::uint32_t>> key(view_index, ids);
  if (const auto known = unpacked_meshes_.find(key); known != unpacked_meshes_.end()) return known->second;
  try {
    DracoMesh mesh = decode_draco(view(view_index), ids, most_triangles, limits_);
    const std::uint64_t index_bytes = sizeof(std::uint32_t) * mesh.indices.size();
    std::uint64_t bytes = index_bytes;
    for (const DracoMesh::Attribute& attribute : mesh.attributes) bytes += sizeof(double) * attribute.values.size();
    count_held(bytes);
    buffer_bytes_ += index_bytes;
    return unpacked_meshes_[key] = std::move(mesh);
  } catch (const CodecProblem& problem) {
    fail_for_codec(problem, "buffer view " + std::to_string(view_index));
  }
}

std::optional<DracoAccessors> Document::draco(const Json& primitive) {
  constexpr const char* kName = "KHR_draco_mesh_compression";
  constexpr std::uint64_t kIdLimit = 1U << 16U, kDoubles = 5130, kWholes = 5125, kList = 4;
  const Json* const packed = extension(primitive, kName);
  if (!packed || !is_required(kName)) return std::nullopt;
  const auto named = packed->find("attributes");
  if (named == packed->end() || !named->is_object()) fail("a primitive's Draco extension has no \"attributes\"");
  std::vector<std::uint32_t> ids;
  std::vector<std::string> names;
  for (const auto& [name, id] : named->items()) {
    if (name != "POSITION" && !name.starts_with('_')) continue;
    names.push_back(name);
    ids.push_back(static_cast<std::uint32_t>(std::min(as_whole(id, "attributes"), kIdLimit)));
  }
  const std::uint64_t corners = required_whole(item("accessors", required_whole(primitive, "indices")), "count");
  const bool is_list = whole(primitive, "mode").value_or(kList) == kList;
  const std::uint64_t most_triangles = is_list ? corners / 3 : corners < 3 ? 0 : corners - 2;
  const DracoMesh& mesh = unpacked_mesh(required_whole(*packed, "bufferView"), ids, most_triangles);
  DracoAccessors accessors;
  accessors.indices.base_ = {reinterpret_cast<const char*>(mesh.indices.data()), sizeof(std::uint32_t),
                             mesh.indices.size(), kWholes, 1};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const DracoMesh::Attribute& from = mesh.attributes[i];
    accessors.attributes[names[i]].base_ = {reinterpret_cast<const char*>(from.values.data()),
                                            sizeof(double) * static_cast<std::uint64_t>(from.components), mesh.points,
                                            kDoubles, from.components};
  }
  return accessors;
}

}  // namespace vantage::internal::io::gltf
