// Certificates of bounds of tours: a program that shares nothing with vantage accepts them, and nothing more than they
// say.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "flight/tour/outer_region.h"
#include "flight/tour/pairs_bound.h"
#include "flight/tour/tour_bound.h"
#include "flight/tour/tour_certificate.h"
#include "support/places.h"
#include "support/random.h"
#include "support/run_program.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "vantage/mission_tour.h"
#include "vantage/volume.h"

namespace vantage::internal::flight::tour {
namespace {

using testing::append;
using testing::make_box_mesh;
using testing::Random;
using testing::read_bytes;
using testing::TemporaryDirectory;
using testing::write_bytes;

testing::ProgramRun checked(const std::filesystem::path& certificate) {
  return testing::run_program(
      "/usr/bin/env", {"python3", (testing::source_folder() / "tools/check_tour.py").string(), certificate.string()});
}

/// Another bound in the same certificate.
void claim(const std::filesystem::path& certificate, double bound_m) {
  std::string text = read_bytes(certificate);
  const std::string key = "\"bound_m\":";
  const std::size_t begin = text.find(key) + key.size(), end = text.find(',', begin);
  char number[40];
  std::snprintf(number, sizeof(number), "%.17g", bound_m);
  text.replace(begin, end - begin, number);
  write_bytes(certificate, text);
}

BoundProblem random_problem(Random& random, int count, bool dwell) {
  BoundProblem problem;
  const Vec3 origin = random.chance(0.4) ? Vec3(691234.5, 5334567.25, 510) : Vec3(0, 0, 0);
  const double size = random.chance(0.2) ? 1e-3 : random.chance(0.2) ? 1e4 : 100;
  for (int i = 0; i < count; ++i) {
    Mesh mesh;
    for (int piece = random.integer(1, 3); piece > 0; --piece) {
      const Vec3 min = origin + size * random.point(-1, 1);
      append(mesh, make_box_mesh(min, min + size * random.point(0.01, 0.5)));
    }
    problem.regions.push_back(OuterRegion::given(std::move(mesh), "r" + std::to_string(i)));
    if (dwell) problem.dwell_m.push_back(random.chance(0.5) ? 0 : size * random.uniform(0, 0.5));
  }
  problem.closed = random.chance(0.5);
  if (random.chance(0.5)) problem.turn_radius_m = size * random.uniform(0.01, 0.5);
  if (!problem.closed || random.chance(0.3)) problem.start = origin + size * random.point(-1, 1);
  if (!problem.closed && random.chance(0.5)) problem.finish = origin + size * random.point(-1, 1);
  return problem;
}

TEST(TourBoundCertificate, IsAcceptedAndProvesNoMore) {
  Random random(31);
  int above = 0;
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const bool by_pairs = round % 2 == 0;
    const BoundProblem problem = random_problem(random, by_pairs ? 5 : random.integer(1, 6), round % 3 == 0);
    BoundOptions options;
    options.by_pairs = by_pairs;
    options.by_insertion = !by_pairs;
    options.most_nodes = 30;
    options.time_limit_s = 20;
    const TourBound bound = bound_tour(problem, {}, options);
    EXPECT_EQ(bound.kind == BoundKind::pairs, by_pairs && has_pairs_bound());
    const TemporaryDirectory folder;
    const std::filesystem::path file = folder / "tour.cert";
    write_tour_certificate(bound, file);
    const testing::ProgramRun run = checked(file);
    ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
    const TourCertificateCheck check = verify_tour_certificate(file);
    EXPECT_TRUE(check.is_accepted) << check.reason;
    EXPECT_EQ(check.bound_m, bound.length_m);
    ASSERT_TRUE(check.proved_m);
    EXPECT_GE(*check.proved_m, bound.length_m);
    EXPECT_EQ(check.regions.size(), bound.regions.size());
    EXPECT_EQ(check.closed, problem.closed);
    EXPECT_EQ(check.turn_radius_m, problem.turn_radius_m);
    // All that is proved is accepted, and nothing above it.
    claim(file, *check.proved_m);
    EXPECT_TRUE(verify_tour_certificate(file).is_accepted);
    if (round < 4) {
      EXPECT_EQ(checked(file).exit_code, 0);
    }
    claim(file, std::nextafter(*check.proved_m, 1e300));
    EXPECT_FALSE(verify_tour_certificate(file).is_accepted);
    if (round < 4) {
      EXPECT_EQ(checked(file).exit_code, 1);
    }
    // What rounding took from the bound is less than a millionth of it.
    claim(file, bound.length_m * (1 + 1e-6) + 1e-9);
    const testing::ProgramRun more = checked(file);
    above += more.exit_code == 1 && more.err.starts_with("refused: ") ? 1 : 0;
  }
  EXPECT_EQ(above, 12);
}

// One position sees all: no search is needed, and the certificate says so in a form that is read.
TEST(TourBoundCertificate, OfATourWithoutLengthIsAccepted) {
  for (const bool closed : {true, false}) {
    for (const double dwell_m : {0.0, 1.0}) {
      SCOPED_TRACE(closed);
      SCOPED_TRACE(dwell_m);
      BoundProblem problem;
      problem.regions = {OuterRegion::given(make_box_mesh({0, 0, 0}, {3, 3, 3}), "a"),
                         OuterRegion::given(make_box_mesh({1, 1, 1}, {4, 4, 4}), "b")};
      problem.dwell_m = {dwell_m, dwell_m};
      problem.start = Vec3(2, 2, 2);
      problem.closed = closed;
      BoundOptions options;
      options.by_pairs = false;
      Incumbent incumbent;
      incumbent.length_m = 0;
      const TourBound bound = bound_tour(problem, incumbent, options);
      EXPECT_EQ(bound.length_m, 0);
      const TemporaryDirectory folder;
      const std::filesystem::path file = folder / "tour.cert";
      write_tour_certificate(bound, file);
      const testing::ProgramRun run = checked(file);
      EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
      const TourCertificateCheck check = verify_tour_certificate(file);
      EXPECT_TRUE(check.is_accepted) << check.reason;
    }
  }
}

TEST(TourBoundCertificate, OfAComputedVolumeIsRefused) {
  BoundProblem problem;
  problem.regions = {OuterRegion::given(make_box_mesh({0, 0, 0}, {1, 1, 1}), "a"),
                     OuterRegion::given(make_box_mesh({8, 0, 0}, {9, 1, 1}), "b")};
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder / "tour.cert";
  write_tour_certificate(bound_tour(problem), file);
  ASSERT_EQ(checked(file).exit_code, 0);
  // The same mesh as `vantage compute` writes it.
  Volume volume = volume_of_mesh(problem.regions[1].mesh(), "range");
  volume.provenance.emplace();
  volume.provenance->method = "exact";
  volume.provenance->target.parts = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  volume.lift_m = {0};
  write_volume(volume, folder / "tour.region1.ply");
  const testing::ProgramRun run = checked(file);
  EXPECT_EQ(run.exit_code, 1) << run.err << run.out;
  EXPECT_TRUE(run.err.starts_with("refused: ")) << run.err;
  EXPECT_FALSE(verify_tour_certificate(file).is_accepted);
}

}  // namespace
}  // namespace vantage::internal::flight::tour
