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

/// A multipolygon with these tags has a wall or trees along its members, whatever it bounds besides.
bool has_line_round(const Tags& tags);

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

/// How high it is, or how many levels it has.
bool says_height(const Tags& tags);

/// What a piece of a ring of `area` says is of something else: a fence, a park.
bool is_of_another(const Tags& piece, const Tags& area);

/// These tags with the heights and the roof of others in place of their own.
Tags with_heights(const Tags& tags, const Tags& heights);

/// What others say of an area's height besides. What is `of_it` counts as its own where it says none itself.
void add_heights(Area& area, const Tags& others, bool of_it);

}  // namespace vantage::internal::osm
