#include "summary.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <set>
#include <vector>

namespace attack {
namespace {

__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...) {
  char text[300];
  std::va_list values;
  va_start(values, pattern);
  std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  return text;
}

constexpr const char* kHeading = "%-18s %6s %8s %5s %7s %10s %8s %8s %8s | %5s %8s %6s | %6s %9s %9s\n";

/// "square | walls | ground, tilted, far": the parts of it.
std::vector<std::string> split(const std::string& kind) {
  std::vector<std::string> parts;
  std::string part;
  for (const char letter : kind + "|") {
    if (letter != '|' && letter != ',') {
      part += letter;
      continue;
    }
    const std::size_t begin = part.find_first_not_of(' '), end = part.find_last_not_of(' ');
    if (begin != std::string::npos) parts.push_back(part.substr(begin, end - begin + 1));
    part.clear();
  }
  return parts;
}

}  // namespace

void Summary::Row::add(const Judgement& j) {
  ++scenes;
  const bool is_computed = j.status == "computed";
  const bool is_refused = j.status.rfind("refused", 0) == 0;
  computed += is_computed;
  refused += is_refused;
  empty += !is_computed && !is_refused && !j.status.empty();
  wrong += j.wrong();
  touching += j.find(FindingKind::touching) || j.find(FindingKind::shallow);
  query += j.find(FindingKind::query_under) || j.find(FindingKind::query_mesh) || j.find(FindingKind::blocked_by);
  viewpoints += j.viewpoints;
  proved += j.proved;
  smaller += j.proved_smaller;
  unproved += j.unproved;
  losing += j.find(FindingKind::under_claim) != nullptr;
  if (!is_computed) return;
  ++measured;
  lost += j.lost;
  most_lost = std::max(most_lost, j.lost);
}

std::string Summary::Row::text(const std::string& name) const {
  return format("%-18s %6zu %8zu %5zu %7zu %10zu %8zu %8zu %8zu | %5zu %8zu %6zu | %6zu %9.4f %9.4f\n", name.c_str(),
                scenes, computed, empty, refused, viewpoints, proved, smaller, unproved, wrong, touching, query, losing,
                measured > 0 ? 100 * lost / static_cast<double>(measured) : 0.0, 100 * most_lost);
}

void Summary::add(const Case& c, const Judgement& judgement) {
  all_.add(judgement);
  by_scale_[c.scale].add(judgement);
  const std::vector<std::string> parts = split(c.kind);
  if (!parts.empty()) by_target_[parts[0]].add(judgement);
  for (const std::string& thing : std::set<std::string>(parts.begin() + !parts.empty(), parts.end()))
    by_thing_[thing].add(judgement);
  ++statuses_[judgement.status.empty() ? "died" : judgement.status];
  for (const Finding& f : judgement.findings) ++classes_[f.which];
  wrong_ += judgement.wrong();
}

std::string Summary::text() const {
  const auto heading = [](const char* name) {
    return format("\n") + format(kHeading, name, "scenes", "computed", "empty", "refused", "viewpoints", "proved",
                                 "smaller", "unproved", "WRONG", "touching", "query", "losing", "lost %", "most %");
  };
  std::string text = heading("scale, m");
  for (const auto& [scale, row] : by_scale_) text += row.text(format("%g", scale));
  text += heading("target");
  for (const auto& [name, row] : by_target_) text += row.text(name);
  text += heading("scene, pose");
  for (const auto& [name, row] : by_thing_) text += row.text(name);
  text += heading("all") + all_.text("") + "\nended as:\n";
  for (const auto& [status, count] : statuses_) text += format("%8zu  %s\n", count, status.c_str());
  text += "\nfound in scenes:\n";
  for (const auto& [which, count] : classes_)
    text += format("%8zu  %s%s\n", count, name_of(which), is_wrong(which) ? "  WRONG" : "");
  text += format("\nattack: %zu scenes, %zu wrong\n", all_.scenes, wrong_);
  return text;
}

}  // namespace attack
