// That the judge of meshes objects to verdicts that are wrong.
#include "mesh_self_test.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include "mesh_judge.h"

namespace attack {
namespace {

using vantage::ProofVerdict;

bool is_found(const MeshJudgement& judgement, const std::string& what) {
  return std::any_of(judgement.findings.begin(), judgement.findings.end(),
                     [&](const MeshFinding& finding) { return finding.what == what; });
}

struct Count {
  int wrong = 0, found = 0;
};

/// Says that all is proved.
Verdicts believing(const Verdicts& verdicts) {
  Verdicts blind = verdicts;
  for (vantage::ProofReport& report : blind.reports) {
    for (vantage::ClaimProof& claim : report.claims) claim.verdict = ProofVerdict::proved;
  }
  return blind;
}

/// With witnesses that are somewhere else.
Verdicts with_witnesses_moved(const Verdicts& verdicts, const Vec3& by) {
  Verdicts moved = verdicts;
  for (vantage::ProofReport& report : moved.reports) {
    if (report.witness) report.witness->viewpoint += by;
    for (vantage::ClaimProof& claim : report.claims) {
      if (claim.place) *claim.place += by;
    }
  }
  return moved;
}

}  // namespace

bool mesh_self_test() {
  constexpr std::uint64_t kSeed = 9;
  constexpr std::size_t kMeshes = 1500;
  std::map<std::string, Count> claims, witnesses;
  for (std::size_t i = 0; i < kMeshes; ++i) {
    const std::optional<MeshCase> c = draw_mesh_case(kSeed, i);
    if (!c || c->lift_m > 0) continue;
    const Verdicts verdicts = prove(*c);
    if (verdicts.reports.empty() || verdicts.of_all() != ProofVerdict::wrong) continue;
    const MeshJudgement blind = judge_mesh(*c, believing(verdicts));
    const MeshJudgement astray =
        judge_mesh(*c, with_witnesses_moved(verdicts, 1e3 * vantage::range_limit_m(c->sensor) * Vec3::UnitX()));
    for (const std::string& name : verdicts.names()) {
      if (verdicts.of(name) != ProofVerdict::wrong) continue;
      claims[name] = {claims[name].wrong + 1, claims[name].found + (is_found(blind, "unsound: " + name) ? 1 : 0)};
      witnesses[name] = {witnesses[name].wrong + 1,
                         witnesses[name].found + (is_found(astray, "false witness: " + name) ? 1 : 0)};
    }
  }
  int failures = 0;
  Count all;
  for (const auto& [name, count] : claims) {
    std::printf("self-test: of %d meshes that are wrong in %s, %d are found\n", count.wrong, name.c_str(), count.found);
    all = {all.wrong + count.wrong, all.found + count.found};
    if (2 * count.found < count.wrong) ++failures;
  }
  if (10 * all.found < 8 * all.wrong) ++failures;  // others are so by hardly more than what is allowed
  for (const auto& [name, count] : witnesses) {
    if (count.found == count.wrong) continue;
    std::printf("self-test: of %d witnesses of %s that are elsewhere, %d are found\n", count.wrong, name.c_str(),
                count.found);
    ++failures;
  }
  if (claims.size() < 10) {
    std::printf("self-test: only %zu claims are ever wrong\n", claims.size());
    ++failures;
  }
  return failures == 0;
}

}  // namespace attack
