#include "minimise.h"

#include <algorithm>
#include <array>
#include <map>

#include "findings_text.h"
#include "isolated.h"

namespace attack {
namespace {

class Minimiser {
 public:
  Minimiser(Case c, const Finding& finding, const JudgeOptions& options, unsigned seconds, int tries)
      : best_(std::move(c)),
        which_(finding.which),
        least_(finding.share / 3),
        options_(options),
        seconds_(seconds),
        tries_(tries) {}

  Case run() {
    drop_extras();
    drop_triangles();
    for (vantage::Target& part : best_.parts) drop_corners(static_cast<std::size_t>(&part - best_.parts.data()));
    drop_triangles();
    drop_unused();
    return best_;
  }

 private:
  bool keep_if_failing(const Case& smaller) {
    if (tries_-- <= 0) return false;
    const Judgement judgement = judge_isolated(smaller, options_, seconds_);
    const Finding* finding = judgement.find(which_);
    if (finding == nullptr || finding->share < least_) return false;
    best_ = smaller;
    return true;
  }

  void drop_extras() {
    Case c = best_;
    c.navigation = {};
    if (!best_.navigation.empty()) keep_if_failing(c);
    c = best_;
    c.sensor = {};
    keep_if_failing(c);
    while (best_.parts.size() > 1) {
      c = best_;
      c.parts.erase(c.parts.begin());
      if (keep_if_failing(c)) continue;
      c = best_;
      c.parts.pop_back();
      if (!keep_if_failing(c)) break;
    }
    c = best_;
    c.parts[0].offset_m = 0;
    if (best_.parts[0].offset_m != 0) keep_if_failing(c);
  }

  void drop_triangles() {
    for (std::size_t chunk = std::max<std::size_t>(best_.scene.mesh.triangles.size() / 2, 1); chunk > 0; chunk /= 2) {
      for (std::size_t at = 0; at < best_.scene.mesh.triangles.size();) {
        Case c = best_;
        const std::size_t end = std::min(at + chunk, c.scene.mesh.triangles.size());
        if (end - at == c.scene.mesh.triangles.size()) break;  // a scene has at least one
        const auto begin = static_cast<std::ptrdiff_t>(at), stop = static_cast<std::ptrdiff_t>(end);
        c.scene.mesh.triangles.erase(c.scene.mesh.triangles.begin() + begin, c.scene.mesh.triangles.begin() + stop);
        c.scene.object_of.erase(c.scene.object_of.begin() + begin, c.scene.object_of.begin() + stop);
        if (!keep_if_failing(c)) at = end;
      }
    }
  }

  void drop_corners(std::size_t part) {
    for (std::size_t at = 0; best_.parts[part].parts[0].size() > 3 && at < best_.parts[part].parts[0].size();) {
      Case c = best_;
      c.parts[part].parts[0].erase(c.parts[part].parts[0].begin() + static_cast<std::ptrdiff_t>(at));
      if (!keep_if_failing(c)) ++at;
    }
  }

  /// Vertices and objects that no triangle uses.
  void drop_unused() {
    const vantage::Scene old = best_.scene;
    vantage::Scene& scene = best_.scene;
    scene.mesh.vertices.clear();
    scene.objects.clear();
    std::map<std::uint32_t, std::uint32_t> objects;
    std::map<std::array<double, 3>, std::uint32_t> vertices;
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
      const auto object = objects.try_emplace(old.object_of[i], static_cast<std::uint32_t>(objects.size()));
      if (object.second) scene.objects.push_back(old.objects[old.object_of[i]]);
      scene.object_of[i] = object.first->second;
      for (std::uint32_t& corner : scene.mesh.triangles[i]) {
        const vantage::Vec3& p = old.mesh.vertices[corner];
        const auto vertex =
            vertices.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(scene.mesh.vertices.size()));
        if (vertex.second) scene.mesh.vertices.push_back(p);
        corner = vertex.first->second;
      }
    }
  }

  Case best_;
  FindingKind which_;
  double least_;
  JudgeOptions options_;
  unsigned seconds_;
  int tries_;
};

}  // namespace

Judgement judge_isolated(const Case& c, const JudgeOptions& options, unsigned seconds) {
  const Exit exit = run_isolated(seconds, [&] { return to_text(judge(c, ask_engine(c), options)); });
  if (!exit.crashed && !exit.hung) return from_text(exit.text);
  Judgement judgement;
  judgement.status = exit.hung ? "hang" : "crash";
  judgement.add({exit.hung ? FindingKind::hang : FindingKind::crash, 0, vantage::Vec3::Zero(), exit.how});
  return judgement;
}

Case minimise(const Case& c, const Finding& finding, const JudgeOptions& options, unsigned seconds, int tries) {
  return Minimiser(c, finding, options, seconds, tries).run();
}

}  // namespace attack
