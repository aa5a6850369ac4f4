// Our own, not that of GoogleTest's library: how that was compiled, and so hardened, is up to others.
#include <gtest/gtest.h>

#include "vantage/city.h"
#include "vantage/spheres.h"

int main(int argc, char** argv) {
  vantage::enable_maps();
  vantage::enable_spheres();
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
