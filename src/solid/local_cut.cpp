#include "solid/local_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/edges.h"
#include "core/pieces.h"
#include "core/triangle_contact.h"
#include "core/triangle_tree.h"

namespace vantage::internal::solid {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

/// Fewer facets than these are not worth a fan.
constexpr std::ptrdiff_t kFewest = 32;

/// A group's box is grown by this part of its diagonal, so that there is room in it for the fan's point beside facets
/// that are all in one plane.
constexpr double kRoom = 0.05;

struct Group {
  std::vector<std::uint32_t> facets;
  Vec3 apex = Vec3::Zero();
  bool is_inside = false;  ///< of the solid
};

/// Finds the groups: boxes are halved until the surface of the solid does not touch them, or they hold few facets.
class Grouping {
 public:
  Grouping(const Mesh& volume, const Mesh& surface) : volume_(volume), surface_(surface), tree_(surface) {
    const std::size_t count = volume.triangles.size();
    centres_.resize(count);
    order_.resize(count);
    for (std::uint32_t t = 0; t < count; ++t) {
      order_[t] = t;
      const auto& [a, b, c] = volume.triangles[t];
      centres_[t] = (volume.vertices[a] + volume.vertices[b] + volume.vertices[c]) / 3;
    }
  }

  std::vector<Group> run(const core::ProgressReporter& progress) {
    split(std::span(order_), progress);
    return std::move(groups_);
  }

 private:
  void split(std::span<std::uint32_t> facets, const core::ProgressReporter& progress);
  bool is_quiet(const Box& box) const;

  const Mesh& volume_;
  const Mesh& surface_;
  core::TriangleTree tree_;
  std::vector<Vec3> centres_;
  std::vector<std::uint32_t> order_;
  std::vector<Group> groups_;
};

bool Grouping::is_quiet(const Box& box) const {
  return !tree_.any_near(box, [&](std::uint32_t t) {
    const auto& [a, b, c] = surface_.triangles[t];
    return core::may_touch({surface_.vertices[a], surface_.vertices[b], surface_.vertices[c]}, box);
  });
}

void Grouping::split(std::span<std::uint32_t> facets, const core::ProgressReporter& progress) {
  progress.tick();
  if (static_cast<std::ptrdiff_t>(facets.size()) < kFewest) return;
  Box box, centres;
  for (const std::uint32_t t : facets) {
    centres.extend(centres_[t]);
    for (const std::uint32_t v : volume_.triangles[t]) box.extend(volume_.vertices[v]);
  }
  const double room = kRoom * (box.max - box.min).norm();
  box.min.array() -= room;
  box.max.array() += room;
  if (is_quiet(box)) {
    Group group;
    group.facets.assign(facets.begin(), facets.end());
    // Off the middle: facets in a plane through it would make fans without area.
    group.apex = (box.min + box.max) / 2 + room * Vec3(0.61, -0.53, 0.47);
    group.is_inside = tree_.winding_number(group.apex) != 0;
    groups_.push_back(std::move(group));
    return;
  }
  Eigen::Index axis = 0;
  if (!((centres.max - centres.min).maxCoeff(&axis) > 0)) return;
  const double middle = (centres.min[axis] + centres.max[axis]) / 2;
  const auto second =
      std::stable_partition(facets.begin(), facets.end(), [&](std::uint32_t t) { return centres_[t][axis] < middle; });
  const auto count = static_cast<std::size_t>(second - facets.begin());
  split(facets.first(count), progress);
  split(facets.subspan(count), progress);
}

/// A position, bit for bit.
struct Position {
  std::array<std::uint64_t, 3> bits;
  explicit Position(const Vec3& at) {
    for (unsigned axis = 0; axis < 3; ++axis) bits[axis] = std::bit_cast<std::uint64_t>(at[axis] + 0.0);
  }
  bool operator==(const Position&) const = default;
};
struct HashPosition {
  std::size_t operator()(const Position& p) const {
    return (p.bits[0] * 0x9e3779b97f4a7c15U ^ p.bits[1]) * 0xbf58476d1ce4e5b9U ^ p.bits[2] * 0x94d049bb133111ebU;
  }
};

/// The volume with its groups taken out, and put back after the boolean.
class Replacement {
 public:
  /// `free_label`: neither the volume nor the solid has it, nor a larger one.
  Replacement(const LabelledMesh& volume, std::vector<Group> groups, std::uint32_t free_label);

  /// With fans in the groups' places.
  const LabelledMesh& reduced() const { return reduced_; }

  /// The groups in the places of their fans in the boolean's result. Nothing where they do not fit.
  std::optional<LabelledMesh> restored(LabelledMesh cut, CutKind kind) const;

 private:
  /// A side of a group's facet beyond which another group begins, or none.
  struct Border {
    std::uint32_t from, to, group;
  };

  void find_borders();
  bool give_back_pinched();
  std::size_t corners_on_border(std::uint32_t facet) const {
    const auto& [a, b, c] = volume_.mesh.triangles[facet];
    return std::size_t{0} + is_on_border_[a] + is_on_border_[b] + is_on_border_[c];
  }
  void add_fans();

  const LabelledMesh& volume_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> group_of_;     ///< of a facet, or kNone
  std::vector<std::uint8_t> is_on_border_;  ///< of a vertex
  std::vector<Border> borders_;
  LabelledMesh reduced_;
  std::uint32_t first_fan_label_;
};

Replacement::Replacement(const LabelledMesh& volume, std::vector<Group> groups, std::uint32_t free_label)
    : volume_(volume),
      groups_(std::move(groups)),
      group_of_(volume.mesh.triangles.size(), kNone),
      first_fan_label_(free_label) {
  for (std::uint32_t g = 0; g < groups_.size(); ++g) {
    for (const std::uint32_t t : groups_[g].facets) group_of_[t] = g;
  }
  find_borders();
  while (give_back_pinched()) find_borders();
  add_fans();
}

/// A side on a border has both ends there, where facets of several groups meet, or of one and of none. Few have.
void Replacement::find_borders() {
  const Mesh& mesh = volume_.mesh;
  constexpr std::uint32_t kUnseen = kNone - 1;
  std::vector<std::uint32_t> group_at(mesh.vertices.size(), kUnseen);
  is_on_border_.assign(mesh.vertices.size(), 0);
  for (std::uint32_t t = 0; t < group_of_.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (group_at[v] == kUnseen) group_at[v] = group_of_[t];
      if (group_at[v] != group_of_[t]) is_on_border_[v] = 1;
    }
  }
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> groups;
  for (std::uint32_t t = 0; t < group_of_.size(); ++t) {
    if (corners_on_border(t) < 2) continue;
    triangles.push_back(mesh.triangles[t]);
    groups.push_back(group_of_[t]);
  }
  borders_.clear();
  const std::vector<core::EdgeUse> uses = core::edge_uses(triangles, mesh.vertices.size());
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    for (const core::EdgeUse& use : edge) {
      const std::uint32_t group = groups[use.triangle];
      if (group == kNone) continue;
      const bool is_border = std::any_of(edge.begin(), edge.end(),
                                         [&](const core::EdgeUse& other) { return groups[other.triangle] != group; });
      if (is_border) borders_.push_back({use.forward ? use.low : use.high, use.forward ? use.high : use.low, group});
    }
  });
}

/// The border of a group passes each vertex once at most: a fan that has two umbrellas at a vertex would leave it open
/// which of them belong together. Facets at other vertices are taken out of their groups. False where there are none.
bool Replacement::give_back_pinched() {
  // For each vertex the groups for which a border begins there; few vertices have more than two.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> begins;
  for (const Border& border : borders_) begins.emplace_back(border.from, border.group);
  std::sort(begins.begin(), begins.end());
  std::vector<char> has_to_go(volume_.mesh.vertices.size(), 0);
  bool is_pinched = false;
  for (std::size_t i = 1; i < begins.size(); ++i) {
    if (begins[i] == begins[i - 1]) has_to_go[begins[i].first] = is_pinched = true;
  }
  if (!is_pinched) return false;
  for (std::uint32_t t = 0; t < group_of_.size(); ++t) {
    const Triangle& corners = volume_.mesh.triangles[t];
    if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return has_to_go[v]; })) {
      group_of_[t] = kNone;
    }
  }
  return true;
}

void Replacement::add_fans() {
  const Mesh& mesh = volume_.mesh;
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNone), apex(groups_.size(), kNone);
  const auto vertex = [&](std::uint32_t v) {
    if (number[v] == kNone) {
      number[v] = static_cast<std::uint32_t>(reduced_.mesh.vertices.size());
      reduced_.mesh.vertices.push_back(mesh.vertices[v]);
    }
    return number[v];
  };
  const auto add = [&](const Triangle& triangle, std::uint32_t label) {
    reduced_.mesh.triangles.push_back(triangle);
    reduced_.labels.push_back(label);
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (group_of_[t] != kNone) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    add({vertex(a), vertex(b), vertex(c)}, volume_.labels[t]);
  }
  for (const auto& [from, to, group] : borders_) {
    if (apex[group] == kNone) {
      apex[group] = static_cast<std::uint32_t>(reduced_.mesh.vertices.size());
      reduced_.mesh.vertices.push_back(groups_[group].apex);
    }
    add({vertex(from), vertex(to), apex[group]}, first_fan_label_ + group);
  }
}

/// Whether two triangles meet at each edge between vertices below `count`.
bool is_closed(const std::vector<Triangle>& triangles, std::size_t vertices, std::size_t count) {
  bool closed = true;
  const std::vector<core::EdgeUse> uses = core::edge_uses(triangles, vertices);
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    closed = closed && (edge[0].high >= count || (edge.size() == 2 && edge[0].forward != edge[1].forward));
  });
  return closed;
}

// Within a group facets hang together as they did. So it is closed if it is where the boolean's vertices are.
std::optional<LabelledMesh> Replacement::restored(LabelledMesh cut, CutKind kind) const {
  // Where the rims of fans are now. A place with two vertices is left to the check at the end.
  std::unordered_map<Position, std::uint32_t, HashPosition> rim;
  LabelledMesh result;
  result.mesh.vertices = std::move(cut.mesh.vertices);
  const std::size_t count = result.mesh.vertices.size();
  for (std::size_t t = 0; t < cut.labels.size(); ++t) {
    const Triangle& triangle = cut.mesh.triangles[t];
    if (cut.labels[t] < first_fan_label_) {
      result.mesh.triangles.push_back(triangle);
      result.labels.push_back(cut.labels[t]);
      continue;
    }
    for (const std::uint32_t v : triangle) rim.emplace(Position(result.mesh.vertices[v]), v);
  }
  std::vector<Triangle> at_rim = result.mesh.triangles;
  const bool keeps_inside = kind == CutKind::keep_inside;
  std::vector<std::uint32_t> number(volume_.mesh.vertices.size(), kNone);
  for (std::uint32_t t = 0; t < group_of_.size(); ++t) {
    if (group_of_[t] == kNone || groups_[group_of_[t]].is_inside != keeps_inside) continue;
    Triangle triangle = volume_.mesh.triangles[t];
    for (std::uint32_t& v : triangle) {
      if (number[v] == kNone && is_on_border_[v]) {
        const auto known = rim.find(Position(volume_.mesh.vertices[v]));
        if (known == rim.end()) return std::nullopt;
        number[v] = known->second;
      } else if (number[v] == kNone) {
        number[v] = static_cast<std::uint32_t>(result.mesh.vertices.size());
        result.mesh.vertices.push_back(volume_.mesh.vertices[v]);
      }
      v = number[v];
    }
    result.mesh.triangles.push_back(triangle);
    result.labels.push_back(volume_.labels[t]);
    if (corners_on_border(t) >= 2) at_rim.push_back(triangle);
  }
  if (!is_closed(at_rim, result.mesh.vertices.size(), count)) return std::nullopt;
  core::drop_unused_vertices(result.mesh);
  return result;
}

LocalCut cut_through(const LabelledMesh& volume, const Solid& solid, CutKind kind,
                     const core::ProgressReporter& progress) {
  const Solid whole(volume, "the volume");
  const Solid left =
      kind == CutKind::keep_inside ? intersect(whole, solid, progress) : subtract(whole, solid, progress);
  return {left.to_mesh(), whole.epsilon(), volume.mesh.triangles.size()};
}

}  // namespace

LocalCut cut_locally(const LabelledMesh& volume, const Solid& solid, CutKind kind,
                     const core::ProgressReporter& progress) {
  const LabelledMesh surface = solid.to_mesh();
  if (surface.mesh.empty()) return cut_through(volume, solid, kind, progress);
  std::uint32_t free_label = 0;
  for (const std::vector<std::uint32_t>* labels : {&volume.labels, &surface.labels}) {
    for (const std::uint32_t label : *labels) free_label = std::max(free_label, label + 1);
  }
  const Replacement replacement(volume, Grouping(volume.mesh, surface.mesh).run(progress.part(0, 0.3)), free_label);
  LocalCut cut = cut_through(replacement.reduced(), solid, kind, progress.part(0.3, 1));
  if (auto whole = replacement.restored(std::move(cut.mesh), kind)) {
    cut.mesh = *std::move(whole);
    return cut;
  }
  return cut_through(volume, solid, kind, progress);
}

}  // namespace vantage::internal::solid
