// Our own, not that of GoogleTest's library: how that was compiled, and so hardened, is up to others.
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
