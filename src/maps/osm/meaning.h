// What tags say an object is: an area, a line, an outline. https://wiki.openstreetmap.org/wiki/Area
#pragma once

#include "maps/osm/extract.h"

namespace vantage::internal::osm {

/// Tagged building or building:part, and not as "no".
bool means_building(const Tags& tags);

/// A closed way with these tags bounds an area.
bool means_area(const Tags& tags);

/// A closed way with these tags is a line, whether or not it bounds an area besides: a wall round a garden.
bool means_line(const Tags& tags);

/// What they name is a line by nature, open or closed: a barrier, a dyke, a track.
bool is_linear(const Tags& tags);

/// None but those that say nothing about what a multipolygon is: its meaning is on its outer ways (old-style tagging).
bool says_nothing(const Tags& tags);

/// All that `way` says is said by `area` too, which it bounds: it adds nothing. "building=yes" is said by any
/// building=*.
bool repeats(const Tags& way, const Tags& area);

/// Both say the same, but for what says nothing.
bool says_the_same(const Tags& a, const Tags& b);

/// The tags that all of them have. Of none: none.
Tags common_tags(const std::vector<Tags>& all);

/// What `other` says of a height besides, as one more value of a list ("9;12"), of which the largest counts.
void add_heights(Tags& tags, const Tags& other);

}  // namespace vantage::internal::osm
