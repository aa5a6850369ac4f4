// The options that say what is to be made of a file: of `vantage scene` and `vantage inspect`.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <string>
#include <vector>

#include "vantage/scene_source.h"

namespace vantage::cli {

/// As typed; empty where not given.
struct SceneOptions {
  std::string input;
  std::string center, bbox, window, origin;
  std::string radius, terrain, error, detail, ground, sea_level, z_unit, void_height;
  std::string up = "z", scale = "1", lod, crs, missing = "block";
  std::vector<std::string> settings, without;
  bool partial = false;
};

/// All but the input, which commands name in their own way.
void add_scene_options(CLI::App& command, SceneOptions& options);

/// Throws Error(input) for a file that cannot be read (`what` begins the message: "the file"), for what cannot be
/// parsed, and for options that mean nothing for this kind of file.
SceneSource scene_source(const SceneOptions& options, const std::string& what);

/// The latitude and longitude of option `name`; throws Error(input) for what is no pair of numbers.
std::array<double, 2> place_option(const std::string& name, const std::string& text);

}  // namespace vantage::cli
