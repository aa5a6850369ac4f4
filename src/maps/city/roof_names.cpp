// The names of roofs: those of the scheme, and other spellings of them that are in use.
//
//   built as      names
//   flat          flat
//   gabled        gabled, gable, pitched, saddle
//   hipped        hipped, hip
//   half-hipped   half-hipped, half_hip, clipped_gable, jerkinhead
//   pyramidal     pyramidal, pyramid, tented, tent, spire
//   skillion      skillion, lean-to, mono-pitched, monopitch, single-pitched, pent, shed, sloped, slanted
//   gambrel       gambrel
//   mansard       mansard, mansarde
//   dome          dome, domed, hemisphere
//   onion         onion, bulbous
//   cone          cone, conical
//   round         round, rounded, barrel, barrel_vault, vault, arched
//   saltbox       saltbox
//
// Of others (cross_gabled, dutch_gabled, sawtooth, many, …) a box stands in that is as high as their top.
#include <algorithm>
#include <array>
#include <string>

#include "maps/city/building_form.h"

namespace vantage::internal::city {
namespace {

struct Known {
  std::string_view name;
  RoofShape shape;
};

// Spelt with underscores.
constexpr std::array kKnown = {
    Known{"flat", RoofShape::flat},
    Known{"gabled", RoofShape::gabled},
    Known{"gable", RoofShape::gabled},
    Known{"pitched", RoofShape::gabled},
    Known{"saddle", RoofShape::gabled},
    Known{"hipped", RoofShape::hipped},
    Known{"hip", RoofShape::hipped},
    Known{"half_hipped", RoofShape::half_hipped},
    Known{"half_hip", RoofShape::half_hipped},
    Known{"clipped_gable", RoofShape::half_hipped},
    Known{"jerkinhead", RoofShape::half_hipped},
    Known{"pyramidal", RoofShape::pyramidal},
    Known{"pyramid", RoofShape::pyramidal},
    Known{"tented", RoofShape::pyramidal},
    Known{"tent", RoofShape::pyramidal},
    Known{"spire", RoofShape::pyramidal},
    Known{"skillion", RoofShape::skillion},
    Known{"lean_to", RoofShape::skillion},
    Known{"mono_pitched", RoofShape::skillion},
    Known{"monopitched", RoofShape::skillion},
    Known{"mono_pitch", RoofShape::skillion},
    Known{"monopitch", RoofShape::skillion},
    Known{"single_pitched", RoofShape::skillion},
    Known{"pent", RoofShape::skillion},
    Known{"shed", RoofShape::skillion},
    Known{"sloped", RoofShape::skillion},
    Known{"slanted", RoofShape::skillion},
    Known{"gambrel", RoofShape::gambrel},
    Known{"mansard", RoofShape::mansard},
    Known{"mansarde", RoofShape::mansard},
    Known{"dome", RoofShape::dome},
    Known{"domed", RoofShape::dome},
    Known{"hemisphere", RoofShape::dome},
    Known{"onion", RoofShape::onion},
    Known{"bulbous", RoofShape::onion},
    Known{"cone", RoofShape::cone},
    Known{"conical", RoofShape::cone},
    Known{"round", RoofShape::round},
    Known{"rounded", RoofShape::round},
    Known{"barrel", RoofShape::round},
    Known{"barrel_vault", RoofShape::round},
    Known{"vault", RoofShape::round},
    Known{"arched", RoofShape::round},
    Known{"saltbox", RoofShape::saltbox},
};

}  // namespace

std::string_view text(RoofShape shape) {
  static constexpr std::array<std::string_view, kRoofShapes> names = {
      "flat",    "gabled", "hipped", "half-hipped", "pyramidal", "skillion", "gambrel",
      "mansard", "dome",   "onion",  "cone",        "round",     "saltbox"};
  return names[static_cast<std::size_t>(shape)];
}

std::optional<RoofShape> parse_roof_shape(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  std::string name(text);
  for (char& c : name) {
    if (c == '-' || c == ' ') c = '_';
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  const auto found = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& known) { return known.name == name; });
  if (found == kKnown.end()) return std::nullopt;
  return found->shape;
}

}  // namespace vantage::internal::city
