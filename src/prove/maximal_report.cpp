// What witnesses of facets come to.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "prove/maximal.h"
#include "vantage/prove.h"

namespace vantage {
namespace {

double facet_area(const Mesh& mesh, std::size_t facet) {
  const auto& [a, b, c] = mesh.triangles[facet];
  return surface_area({{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, {{0, 1, 2}}});
}

bool is_limit(WitnessKind kind) { return kind == WitnessKind::navigation || kind == WitnessKind::sensor; }

/// Rows, shares and open facets, of the witnesses and the names of limits.
void count_witnesses(const Mesh& volume, MaximalProof& proof) {
  std::map<std::pair<WitnessKind, std::uint32_t>, MaximalProof::Row> rows;
  double all = 0, without = 0;
  proof.open.clear();
  for (std::uint32_t i = 0; i < proof.facets.size(); ++i) {
    const FacetWitness& facet = proof.facets[i];
    const double area = facet_area(volume, i);
    all += area;
    without += facet.open * area;
    MaximalProof::Row& row = rows[{facet.kind, is_limit(facet.kind) ? facet.limit : 0}];
    row.kind = facet.kind;
    if (is_limit(facet.kind)) row.limit = proof.limits[facet.limit];
    ++row.facets;
    row.area_share += (1 - facet.open) * area;
    if (facet.open > 0) proof.open.push_back(i);
  }
  MaximalProof::Row none;
  if (const auto at = rows.find({WitnessKind::none, 0}); at != rows.end()) none = at->second;
  none.area_share = without;
  rows.erase({WitnessKind::none, 0});
  proof.rows.clear();
  for (const auto& [key, row] : rows) proof.rows.push_back(row);
  if (!proof.open.empty()) proof.rows.push_back(none);
  for (MaximalProof::Row& row : proof.rows) row.area_share /= all;
  proof.proved_share = 1 - without / all;
  // Also where what is open is too small to count.
  if (!proof.open.empty()) proof.proved_share = std::min(proof.proved_share, std::nextafter(1.0, 0.0));
}

}  // namespace

const char* name_of(WitnessKind kind) {
  switch (kind) {
    case WitnessKind::none:
      return "none";
    case WitnessKind::navigation:
      return "navigation";
    case WitnessKind::sensor:
      return "sensor";
    case WitnessKind::range:
      return "range";
    case WitnessKind::hidden:
      return "hidden";
    case WitnessKind::hidden_in_pieces:
      return "hidden in pieces";
    case WitnessKind::edge_on:
      return "edge-on";
    case WitnessKind::target_plane:
      return "target plane";
  }
  return "";
}

bool MaximalProof::conditions_hold() const {
  return std::all_of(conditions.begin(), conditions.end(), [](const MaximalCondition& c) { return c.holds; });
}

MaximalProof join(const MaximalProof& a, const MaximalProof& b, const Mesh& volume) {
  MaximalProof both = a;
  std::vector<std::uint32_t> number;
  for (const std::string& name : b.limits) {
    const auto at = std::find(both.limits.begin(), both.limits.end(), name);
    number.push_back(static_cast<std::uint32_t>(at - both.limits.begin()));
    if (at == both.limits.end()) both.limits.push_back(name);
  }
  for (std::size_t i = 0; i < both.facets.size(); ++i) {
    if (!(b.facets[i].open < both.facets[i].open)) continue;
    both.facets[i] = b.facets[i];
    if (is_limit(b.facets[i].kind)) both.facets[i].limit = number[b.facets[i].limit];
  }
  both.conditions = {{"the target is a single polygon, or a point", false}};
  both.point_radius_m = std::max(a.point_radius_m, b.point_radius_m);
  both.seconds += b.seconds;
  count_witnesses(volume, both);
  return both;
}

namespace internal::prove {

void finish_maximal(const Mesh& volume, MaximalProof& proof) { count_witnesses(volume, proof); }

}  // namespace internal::prove
}  // namespace vantage
