#include "io/cityjson_surfaces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "io/join_holes.h"
#include "io/object_text.h"

namespace vantage::internal::io::cityjson {
namespace {

using Ring = std::vector<std::uint32_t>;

void drop_repeated_corners(Ring& ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
}

}  // namespace

void Finding::note(std::vector<std::string>& notes, const char* one, const char* many, const std::string& more) const {
  if (count_ == 0) return;
  std::string text = std::to_string(count_);
  text.append(" ").append(count_ == 1 ? one : many).append(more);
  notes.push_back(text.append(count_ == 1 ? " (of " : " (the first of ").append(shown_word(first_)).append(")"));
}

void SurfaceBuilder::begin_shell(bool is_cavity) {
  in_shell_ = true;
  is_cavity_ = is_cavity;
  shell_.begin();
  about_.reset();
  volume_ = 0;
}

void SurfaceBuilder::end_shell() {
  in_shell_ = false;
  switch (shell_.result()) {
    case ShellCheck::Result::open:
      open_.add(trail_.object());
      tell_open();
      break;
    case ShellCheck::Result::misoriented:
      misoriented_.add(trail_.object());
      break;
    case ShellCheck::Result::closed:
      if (is_cavity_ ? volume_ > 0 : volume_ < 0) inside_out_.add(trail_.object());
      break;
  }
}

/// What is missing lies between the open edges: in their plane, where they have one, and there what they go round an
/// odd number of times, which the triangles from one point to each of them cover. Else the box about them holds it.
void SurfaceBuilder::tell_open() {
  constexpr double kFlatM = 0.01;
  Fault fault{trail_.object(), "solid", "its shell is not closed", "the box of its open edges", {}};
  Mesh fan;
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t end : shell_.open_ends()) {
    fan.vertices.push_back(builder_.vertex(end));
    fault.box.extend(fan.vertices.back());
    middle += (fan.vertices.back() - fan.vertices[0]) / static_cast<double>(shell_.open_ends().size());
  }
  middle += fan.vertices[0];
  const auto farthest = [&](const auto& distance) {
    return *std::max_element(fan.vertices.begin(), fan.vertices.end(),
                             [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
  };
  const Vec3 along = farthest([&](const Vec3& p) { return (p - middle).norm(); }) - middle;
  const Vec3 across = farthest([&](const Vec3& p) { return along.cross(p - middle).norm(); }) - middle;
  const Vec3 normal = along.cross(across).normalized();
  const auto off = [&](const Vec3& p) { return std::abs(normal.dot(p - middle)); };
  if (off(farthest(off)) <= kFlatM / limits_.unit_m) {
    const auto tip = static_cast<std::uint32_t>(fan.vertices.size());
    for (std::uint32_t i = 0; i + 1 < tip; i += 2) fan.triangles.push_back({i, i + 1, tip});
    fan.vertices.push_back(middle);
    fault.instead = "what its open edges go round";
    fault.holder = std::move(fan);
  } else {
    fault.holder = box_mesh(fault.box);
  }
  faults_.push_back(std::move(fault));
}

void SurfaceBuilder::add(std::vector<Ring>& rings) {
  for (Ring& ring : rings) drop_repeated_corners(ring);
  const bool has_border = rings[0].size() >= 3;
  rings.erase(std::remove_if(rings.begin() + 1, rings.end(), [](const Ring& ring) { return ring.size() < 3; }),
              rings.end());
  std::size_t corners = 0;
  for (const Ring& ring : rings) corners += ring.size();
  if (corners > limits_.corners) {
    trail_.fail_as(ErrorCode::mesh_too_large,
                   "a surface has " + std::to_string(corners) + " corners; at most " + std::to_string(limits_.corners) +
                       " can be read",
                   "cut it into smaller ones");
  }
  builder_.begin_face(0);
  if (!has_border || rings.size() == 1) {
    for (const std::uint32_t corner : rings[0]) builder_.add_corner(corner);
  } else {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> vertices;
    std::vector<std::size_t> ends;
    for (const Ring& ring : rings) {
      for (const std::uint32_t corner : ring) {
        points.push_back(builder_.vertex(corner));
        vertices.push_back(corner);
      }
      ends.push_back(points.size());
    }
    std::size_t left_out = 0;
    for (const std::uint32_t i : join_holes(points, ends, left_out)) builder_.add_corner(vertices[i]);
    for (; left_out > 0; --left_out) {
      holes_outside_.add(trail_.object());
      faults_.push_back({trail_.object(), "hole", "it lies outside its surface", "the surface without the hole", {}});
      for (const std::uint32_t corner : vertices) faults_.back().box.extend(builder_.vertex(corner));
    }
  }
  builder_.end_face();
  if (has_border && in_shell_) check_shell(rings);
}

void SurfaceBuilder::check_shell(const std::vector<Ring>& rings) {
  for (const Ring& ring : rings) {
    if (!about_) about_ = builder_.vertex(ring[0]);
    const Vec3 first = builder_.vertex(ring[0]) - *about_;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::uint32_t from = ring[i], to = ring[(i + 1) % ring.size()];
      shell_.add_edge(from, to);
      volume_ += first.dot((builder_.vertex(from) - *about_).cross(builder_.vertex(to) - *about_));
    }
  }
}

void SurfaceBuilder::add_notes(std::vector<std::string>& notes) const {
  open_.note(notes, "shell of a solid is not closed", "shells of solids are not closed");
  misoriented_.note(notes, "shell of a solid has surfaces that face the wrong way",
                    "shells of solids have surfaces that face the wrong way");
  inside_out_.note(notes, "shell of a solid is inside out", "shells of solids are inside out");
  holes_outside_.note(notes, "hole lies outside its surface and is left out",
                      "holes lie outside their surfaces and are left out");
}

}  // namespace vantage::internal::io::cityjson
