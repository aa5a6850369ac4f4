#include "mesh_attack.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <string>

#include "isolated.h"
#include "limit_attack.h"
#include "mesh_judge.h"
#include "vantage/progress.h"

namespace attack {
namespace {

constexpr std::size_t kInOneProcess = 40;

MeshJudgement judged(std::uint64_t seed, std::size_t index) {
  const std::optional<MeshCase> c = draw_mesh_case(seed, index);
  if (!c) return {.status = "unsuitable"};
  MeshJudgement judgement = judge_mesh(*c, prove(*c));
  return judgement;
}

// ---- between processes: a line a mesh ----

std::string line_of(std::size_t index, const MeshJudgement& judgement) {
  std::ostringstream line;
  line.precision(17);
  line << index << '\t' << judgement.status << '\t' << judgement.kind << '\t' << judgement.inside << '\t'
       << judgement.witnesses << '\t' << judgement.claims.size();
  for (const auto& [name, verdict] : judgement.claims) line << '\t' << name << '\t' << verdict;
  for (const MeshFinding& f : judgement.findings) {
    std::string detail = f.detail;
    std::replace_if(
        detail.begin(), detail.end(), [](char c) { return c == '\t' || c == '\n'; }, ' ');
    line << '\t' << f.what << '\t' << f.place.x() << ' ' << f.place.y() << ' ' << f.place.z() << '\t' << detail;
  }
  return line.str();
}

MeshJudgement from_line(const std::string& text, std::size_t& index) {
  std::vector<std::string> fields;
  std::istringstream line(text);
  for (std::string field; std::getline(line, field, '\t');) fields.push_back(field);
  fields.resize(std::max<std::size_t>(fields.size(), 6));
  MeshJudgement judgement{.status = fields[1], .kind = fields[2]};
  index = std::stoull(fields[0]);
  judgement.inside = std::stoull(fields[3]);
  judgement.witnesses = std::stoull(fields[4]);
  std::size_t at = 6;
  for (std::size_t count = std::stoull(fields[5]); count > 0 && at + 1 < fields.size(); --count, at += 2) {
    judgement.claims.emplace_back(fields[at], fields[at + 1]);
  }
  for (; at + 1 < fields.size(); at += 3) {
    MeshFinding f{fields[at], Vec3::Zero(), at + 2 < fields.size() ? fields[at + 2] : ""};
    std::istringstream(fields[at + 1]) >> f.place.x() >> f.place.y() >> f.place.z();
    judgement.findings.push_back(f);
  }
  return judgement;
}

std::string work(std::uint64_t seed, std::size_t begin, std::size_t end) {
  std::string text;
  vantage::with_threads(1, [&] {
    for (std::size_t i = begin; i < end; ++i) text += line_of(i, judged(seed, i)) + "\n";
  });
  return text;
}

// ---- a case that fails, made small ----

/// Takes away what is not needed for the proof to be as wrong.
class MeshMinimiser {
 public:
  MeshMinimiser(MeshCase c, std::string claim, const Vec3& place)
      : best_(std::move(c)), claim_(std::move(claim)), place_(place) {}

  MeshCase run() {
    best_.suspects.clear();
    drop_limits();
    drop_pieces();
    drop_obstacles();
    return best_;
  }

 private:
  void keep_if_wrong(const MeshCase& smaller) {
    const Verdicts verdicts = prove(smaller);
    if (verdicts.of(claim_) == vantage::ProofVerdict::proved && refutes(smaller, verdicts, claim_, place_)) {
      best_ = smaller;
    }
  }

  void drop_limits() {
    every_limit([&](auto limit) {
      MeshCase c = best_;
      leave_out<limit>(c.navigation, c.sensor);
      keep_if_wrong(c);
    });
  }

  void drop_pieces() {
    std::vector<std::uint32_t> parent(best_.volume.vertices.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t v) {
      while (parent[v] != v) v = parent[v];
      return v;
    };
    for (const auto& [a, b, c] : best_.volume.triangles) {
      parent[root(b)] = root(a);
      parent[root(c)] = root(a);
    }
    std::map<std::uint32_t, int> roots;
    for (const vantage::Triangle& t : best_.volume.triangles) ++roots[root(t[0])];
    for (const auto& [piece, count] : roots) {
      MeshCase c = best_;
      std::erase_if(c.volume.triangles, [&, which = piece](const vantage::Triangle& t) { return root(t[0]) == which; });
      if (!c.volume.triangles.empty()) keep_if_wrong(c);
    }
  }

  void drop_obstacles() {
    for (std::uint32_t object = 0; object < best_.scene.objects.size(); ++object) {
      if (object == best_.ground) continue;
      MeshCase c = best_;
      c.scene.mesh.triangles.clear();
      c.scene.object_of.clear();
      for (std::size_t i = 0; i < best_.scene.mesh.triangles.size(); ++i) {
        if (best_.scene.object_of[i] == object) continue;
        c.scene.mesh.triangles.push_back(best_.scene.mesh.triangles[i]);
        c.scene.object_of.push_back(best_.scene.object_of[i]);
      }
      if (!c.scene.mesh.triangles.empty()) keep_if_wrong(c);
    }
  }

  MeshCase best_;
  std::string claim_;
  Vec3 place_;
};

// ---- the run ----

class MeshAttack {
 public:
  explicit MeshAttack(const MeshAttackOptions& options) : options_(options) {}

  int run() {
    const std::size_t end = options_.first + options_.count;
    std::printf("seed %llu, meshes %zu to %zu; one of them: vantage_attack --meshes 1 --seed %llu --only NUMBER\n",
                static_cast<unsigned long long>(options_.seed), options_.first, end - 1,
                static_cast<unsigned long long>(options_.seed));
    Processes processes(options_.jobs, options_.seconds);
    std::size_t next = options_.first;
    while (next < end || !processes.idle()) {
      if (next < end && !processes.full()) {
        const std::size_t begin = next;
        next = std::min(begin + kInOneProcess, end);
        processes.start(begin, [this, begin, next] { return work(options_.seed, begin, next); });
        continue;
      }
      const auto [begin, exit] = processes.next();
      if (!exit.crashed && !exit.hung) {
        note_lines(exit.text);
      } else {
        one_by_one(begin, std::min(begin + kInOneProcess, end));
      }
    }
    print_summary();
    return failures_ > 0 ? 1 : 0;
  }

 private:
  void note_lines(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::size_t index = 0;
      const MeshJudgement judgement = from_line(line, index);
      note(index, judgement);
    }
  }

  /// Of a process that died: which mesh it was.
  void one_by_one(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Exit exit = run_isolated(options_.seconds, [&] { return work(options_.seed, i, i + 1); });
      if (!exit.crashed && !exit.hung) {
        note_lines(exit.text);
      } else {
        note(i, {.status = exit.hung ? "hang" : "crash",
                 .findings = {{exit.hung ? "hang" : "crash", Vec3::Zero(), exit.how}}});
      }
    }
  }

  void note(std::size_t index, const MeshJudgement& judgement) {
    ++statuses_[judgement.status];
    inside_ += judgement.inside;
    witnesses_ += judgement.witnesses;
    for (const auto& [name, verdict] : judgement.claims) ++verdicts_[name][verdict];
    if (options_.told) std::printf("%s\n", line_of(index, judgement).c_str());
    for (const MeshFinding& f : judgement.findings) {
      ++failures_;
      ++found_[f.what];
      std::printf("WRONG %s: mesh %zu (%s) at (%.17g, %.17g, %.17g): %s\n", f.what.c_str(), index,
                  judgement.kind.c_str(), f.place.x(), f.place.y(), f.place.z(), f.detail.c_str());
      if (!options_.out.empty() && found_[f.what] <= options_.written) write(index, f);
    }
    std::fflush(stdout);
  }

  void write(std::size_t index, const MeshFinding& f) {
    std::optional<MeshCase> c = draw_mesh_case(options_.seed, index);
    if (!c) return;
    constexpr std::string_view kUnsound = "unsound: ";
    if (f.what.rfind(kUnsound, 0) == 0) *c = MeshMinimiser(*c, f.what.substr(kUnsound.size()), f.place).run();
    std::string name = f.what;
    std::replace(name.begin(), name.end(), ' ', '-');
    std::erase(name, ':');
    const std::filesystem::path folder =
        options_.out / (name + "-" + std::to_string(options_.seed) + "-" + std::to_string(index));
    write_mesh_case(*c, folder);
    std::ofstream(folder / "README.txt") << f.what << ", at " << f.place.transpose() << ", " << f.detail
                                         << "\ndrawn as mesh " << index << " of seed " << options_.seed << ": "
                                         << c->kind << "\nvantage prove "
                                         << "mission.yaml volume.ply --shrink " << c->shrink << "\n";
    if (c->rounding_m > 0)
      std::ofstream(folder / "README.txt", std::ios::app) << "with a rounding_m of " << c->rounding_m << "\n";
    std::printf("      %zu facets, %zu triangles: %s\n", c->volume.triangles.size(), c->scene.mesh.triangles.size(),
                folder.c_str());
  }

  void print_summary() const {
    std::size_t all = 0;
    for (const auto& [status, count] : statuses_) all += count;
    std::printf("%zu meshes:", all);
    for (const auto& [status, count] : statuses_) std::printf(" %zu %s,", count, status.c_str());
    std::printf(" %zu points of them looked from, %zu witnesses checked\n", inside_, witnesses_);
    std::printf("%-12s %10s %10s %10s\n", "claim", "proved", "wrong", "not proved");
    for (const auto& claim : verdicts_) {
      const auto of = [&](const char* verdict) {
        const auto found = claim.second.find(verdict);
        return found == claim.second.end() ? std::size_t{0} : found->second;
      };
      std::printf("%-12s %10zu %10zu %10zu\n", claim.first.c_str(), of("proved"), of("wrong"), of("not proved"));
    }
    for (const auto& [what, count] : found_) std::printf("WRONG %s: %d\n", what.c_str(), count);
    std::printf("%zu findings\n", failures_);
  }

  MeshAttackOptions options_;
  std::map<std::string, std::size_t> statuses_;
  std::map<std::string, std::map<std::string, std::size_t>> verdicts_;
  std::map<std::string, int> found_;
  std::size_t inside_ = 0, witnesses_ = 0, failures_ = 0;
};

}  // namespace

int attack_with_meshes(const MeshAttackOptions& options) { return MeshAttack(options).run(); }

}  // namespace attack
