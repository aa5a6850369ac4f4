#include <gtest/gtest.h>

#include "vantage/error.h"

namespace vantage {
namespace {

TEST(Error, KeepsItsParts) {
  const Error error(ErrorKind::output, "the disk is full", "volume.ply", "free some space");
  EXPECT_EQ(error.kind(), ErrorKind::output);
  EXPECT_EQ(error.problem(), "the disk is full");
  EXPECT_EQ(error.where(), "volume.ply");
  EXPECT_EQ(error.fix(), "free some space");
}

TEST(Error, SaysWhatWhereAndWhatToDoInThreeLines) {
  EXPECT_STREQ(Error(ErrorKind::input, "what", "where", "fix").what(), "what\nwhere\nfix");
}

TEST(Error, LeavesOutEmptyLines) {
  EXPECT_STREQ(Error(ErrorKind::input, "what", "", "fix").what(), "what\nfix");
  EXPECT_STREQ(Error(ErrorKind::internal, "what", "", "").what(), "what");
}

TEST(Error, IsCaughtAsAStandardException) {
  EXPECT_THROW(throw Error(ErrorKind::cancelled, "stopped", "", ""), std::runtime_error);
}

}  // namespace
}  // namespace vantage
