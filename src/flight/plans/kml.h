// What KML and WPML share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "flight/plans/plan_source.h"
#include "flight/plans/xml_tree.h"

namespace vantage::internal::flight::plans {

/// The text of an element as a number. Throws Error(not_a_number) with its line.
double number_of(const XmlTree& xml, XmlTree::Node node, const PlanSource& source);

/// Up to `most` numbers between single separators: "11.5,48.1,520". Throws Error(plan_syntax).
std::vector<double> numbers_of(std::string_view text, char separator, std::size_t least, std::size_t most,
                               const std::string& where);

/// "line 12".
inline std::string line_of(const XmlTree& xml, XmlTree::Node node) { return "line " + std::to_string(xml.line(node)); }

/// Whether a KML document is a plan of DJI.
bool is_wpml(const XmlTree& xml);
FlightPlan read_wpml(const XmlTree& xml, const PlanSource& source);

}  // namespace vantage::internal::flight::plans
