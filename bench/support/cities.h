// The real scenes that benchmarks and experiments run on, read and prepared once a process, with their targets.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "support/street_targets.h"
#include "vantage/scene.h"

namespace vantage::bench {

struct City {
  const char* name;
  const char* file;  ///< under data/ of the shared folder
  UpAxis up;
  StreetSearch search;
  int targets;
  int tiles = 1;  ///< repeated so often along x and along y
};

extern const City kCharlotte, kMunich, kMunichRepeated, kFlorence, kOpenfoam;

struct PreparedCity {
  Scene scene;  ///< empty where it is repeated
  PreparedScene prepared;
  std::vector<StreetTarget> targets;
};

/// Read, prepared and searched for targets once. Null when the file is absent.
const PreparedCity* prepared_city(const City& city);

/// As read, repeated; the file must be there.
Scene read_city(const City& city);

bool is_there(const City& city);

/// For those who must do without it.
std::string absence(const City& city);

}  // namespace vantage::bench
