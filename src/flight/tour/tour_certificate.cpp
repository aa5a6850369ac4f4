#include "flight/tour/tour_certificate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <variant>

#include "common/atomic_file.h"
#include "common/output.h"
#include "vantage/volume.h"

namespace vantage::internal::flight::tour {
namespace {

using Json = nlohmann::ordered_json;

template <typename T>
void put(std::string& out, T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

Json numbers_of(const std::vector<Direction>& directions) {
  Json list = Json::array();
  for (const Direction& d : directions) list.insert(list.end(), {d[0], d[1], d[2]});
  return list;
}

Json json_of(const InsertionNode& node) {
  switch (node.kind) {
    case InsertionNode::Kind::insert:
      return {"insert", node.what};
    case InsertionNode::Kind::cut:
      return {"cut", node.what, {node.plane.normal[0], node.plane.normal[1], node.plane.normal[2]}, node.plane.offset};
    case InsertionNode::Kind::leaf:
      return {"leaf", numbers_of(node.directions)};
    case InsertionNode::Kind::empty:
      break;
  }
  return Json::array({"empty"});
}

Json json_of(const PairsNode& node) {
  if (node.edge) return {"edge", (*node.edge)[0], (*node.edge)[1]};
  Json sets = Json::array();
  for (const auto& [dual, members] : node.duals.of_set) sets.push_back({dual, members});
  return {"leaf", node.vectors, node.duals.of_edge_at, node.duals.of_region, std::move(sets)};
}

void add_proof(const InsertionTree& tree, Json& proof, std::vector<Json>& lines) {
  proof["kind"] = "insertion";
  proof["root"] = tree.root;
  for (const InsertionNode& node : tree.nodes) lines.push_back(json_of(node));
}

void add_proof(const PairsProof& pairs, Json& proof, std::vector<Json>& lines) {
  proof["kind"] = "pairs";
  proof["origin"] = {pairs.origin.x(), pairs.origin.y(), pairs.origin.z()};
  proof["vectors"] = Json::array();
  for (const std::vector<std::vector<Direction>>& rows : pairs.vectors) {
    Json set = Json::array();
    for (const std::vector<Direction>& row : rows) set.push_back(numbers_of(row));
    proof["vectors"].push_back(std::move(set));
  }
  for (const PairsNode& node : pairs.nodes) lines.push_back(json_of(node));
}

Json or_null(const std::optional<std::size_t>& number) { return number ? Json(*number) : Json(nullptr); }

}  // namespace

std::string region_ply(const OuterRegion& region) {
  const Mesh& mesh = region.mesh();
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment vantage region: ";
  text += name_of(region.kind());
  text += "\nelement vertex " + std::to_string(mesh.vertices.size()) +
          "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
          std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) {
    for (const double x : {v.x(), v.y(), v.z()}) put(text, x);
  }
  for (const Triangle& triangle : mesh.triangles) {
    text += '\3';
    for (const std::uint32_t corner : triangle) put(text, static_cast<std::int32_t>(corner));
  }
  return text;
}

std::string tour_certificate_text(const TourBound& bound, const std::vector<std::string>& files,
                                  const std::string& scene_incomplete) {
  Json json;
  json["format"] = "vantage tour certificate 2";
  if (!scene_incomplete.empty()) json["scene_incomplete"] = scene_incomplete;
  json["bound_m"] = bound.length_m;
  json["turn_radius_m"] = bound.space.turn_radius_m;
  json["closed"] = bound.space.closed;
  json["first"] = or_null(bound.space.first);
  json["last"] = or_null(bound.space.last);
  for (std::size_t r = 0; r < bound.regions.size(); ++r) {
    const OuterRegion& region = bound.regions[r];
    Json out = {{"name", region.name()},
                {"kind", name_of(region.kind())},
                {"dwell_m", bound.space.dwell_m.empty() ? 0.0 : bound.space.dwell_m[r]}};
    if (region.kind() == OuterRegion::Kind::point) {
      const Vec3& at = region.mesh().vertices.front();
      out["at"] = {at.x(), at.y(), at.z()};
    } else {
      out["file"] = files.at(r);
      out["hash"] = volume_hash(region.mesh());
    }
    json["regions"].push_back(std::move(out));
  }
  std::vector<Json> lines;
  std::visit([&](const auto& proof) { add_proof(proof, json["proof"], lines); }, bound.proof);
  json["proof"]["tree"] = Json::array();
  std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);  // in ASCII
  // The tree is the last thing in it, one node a line.
  const std::string end = "]}}";
  text.resize(text.size() - end.size());
  for (std::size_t i = 0; i < lines.size(); ++i) text += (i == 0 ? "\n" : ",\n") + lines[i].dump();
  return text + end + "\n";
}

std::filesystem::path region_file(const std::filesystem::path& certificate, std::size_t region) {
  std::string name = certificate.stem().string();
  for (char& c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!is_plain && c != '_' && c != '.' && c != '-') c = '_';
  }
  return certificate.parent_path() / (name + ".region" + std::to_string(region) + ".ply");
}

void write_tour_certificate(const TourBound& bound, const std::filesystem::path& file,
                            const std::string& scene_incomplete) {
  std::vector<std::string> files;
  std::vector<std::unique_ptr<AtomicFile>> written;
  for (std::size_t r = 0; r < bound.regions.size(); ++r) {
    const std::filesystem::path mesh = region_file(file, r);
    files.push_back(mesh.filename().string());
    if (bound.regions[r].kind() == OuterRegion::Kind::point) continue;
    check_certificate_output(mesh);
    written.push_back(std::make_unique<AtomicFile>(mesh));
    written.back()->write(region_ply(bound.regions[r]));
  }
  check_certificate_output(file);
  written.push_back(std::make_unique<AtomicFile>(file));
  written.back()->write(tour_certificate_text(bound, files, scene_incomplete));
  commit_all(written);
}

}  // namespace vantage::internal::flight::tour
