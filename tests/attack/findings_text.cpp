#include "findings_text.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace attack {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string to_text(const Judgement& j) {
  std::ostringstream out;
  out << std::setprecision(17) << one_line(j.status) << "\n"
      << j.viewpoints << " " << j.proved << " " << j.proved_smaller << " " << j.unproved << " " << j.untried << " "
      << j.facets << " " << j.lift << " " << j.lost << " " << j.worst_gap << "\n";
  for (const Finding& f : j.findings) {
    out << static_cast<int>(f.which) << " " << f.share << " " << f.place.x() << " " << f.place.y() << " " << f.place.z()
        << " " << one_line(f.detail) << "\n";
  }
  return out.str();
}

Judgement from_text(const std::string& text) {
  std::istringstream in(text);
  Judgement j;
  std::getline(in, j.status);
  in >> j.viewpoints >> j.proved >> j.proved_smaller >> j.unproved >> j.untried >> j.facets >> j.lift >> j.lost >>
      j.worst_gap;
  int which = 0;
  Finding f;
  while (in >> which >> f.share >> f.place.x() >> f.place.y() >> f.place.z()) {
    f.which = static_cast<FindingKind>(which);
    in.get();
    std::getline(in, f.detail);
    j.findings.push_back(f);
  }
  return j;
}

}  // namespace attack
