// OpenGL and the CPU render the same depth images of real scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "depth/cpu_depth.h"
#include "depth/device_list.h"
#include "depth/gl_depth.h"
#include "support/depth_probe.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/shared_data.h"

namespace vantage::testing {
namespace {

using depth::Sampling;

constexpr double kRange = 400;

struct RealScene {
  const char* file;
  UpAxis up;
};
constexpr RealScene kScenes[] = {{"charlotte/uptownCharlotte.obj", UpAxis::y},
                                 {"mesh/munich_merged.ply", UpAxis::z},
                                 {"mesh/florence_merged.ply", UpAxis::z},
                                 {"battcave/battcave.obj", UpAxis::y}};

std::vector<Vec3> random_viewpoints(const PreparedScene& scene, Random& random, int count) {
  Box box = scene.statistics().bounds;
  box.max.z() += 50;
  std::vector<Vec3> viewpoints;
  for (int i = 0; i < count; ++i) viewpoints.push_back(random.in_box(box));
  return viewpoints;
}

std::vector<float> render_all(depth::DepthRenderer& renderer, const std::vector<Vec3>& viewpoints, int size,
                              Sampling sampling) {
  std::vector<float> all;
  const core::Stopwatch stopwatch;
  renderer.render({viewpoints, size, sampling, kRange}, [&](std::size_t, std::span<const float> image) {
    all.insert(all.end(), image.begin(), image.end());
  });
  const double took_ms = stopwatch.seconds() * 1000;
  std::cout << "  " << renderer.device().name << ", " << viewpoints.size() << " cube maps of " << size
            << " texels a side: " << took_ms << " ms\n";
  return all;
}

/// What is out of range may be there or not: it counts as just out of range.
double within_range(float inverse_depth, std::size_t texel, int size) {
  const int in_face = static_cast<int>(texel % (static_cast<std::size_t>(size) * size));
  const double u = texel_centre(in_face % size, size), v = texel_centre(in_face / size, size);
  return std::max<double>(inverse_depth, std::sqrt(1 + u * u + v * v) / kRange);
}

struct Agreement {
  std::size_t texels = 0, hits = 0;
  std::size_t differing = 0;  ///< by more than 1e-4, relative
  std::size_t farther = 0;    ///< the first claims more free space than the second
};

/// Adds how the images of `first` differ from those of `second`.
void compare(const std::vector<float>& first, const std::vector<float>& second, int size, Agreement& sum) {
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double a = within_range(first[i], i, size), b = within_range(second[i], i, size);
    sum.differing += std::abs(a - b) > 1e-4 * std::max(a, b);
    sum.farther += a < b * (1 - 1e-6);
    sum.hits += second[i] > 0;
  }
  sum.texels += first.size();
}

class HeavyDepthAgreement : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const RealScene& scene : kScenes) VANTAGE_REQUIRE_SHARED(scene.file);
    list_ = depth::list_devices();
    if (list_.opengl.empty()) GTEST_SKIP() << list_.found.why_no_opengl;
  }

  /// `count` viewpoints in each scene, on each OpenGL device.
  void compare_all(int count, int size, Sampling sampling, const std::function<void(const Agreement&)>& expect) {
    Random random(4201);
    std::vector<Agreement> sums(list_.opengl.size());
    for (const RealScene& file : kScenes) {
      const PreparedScene scene(read_scene(shared_data(file.file), {file.up, 1.0}));
      std::cout << file.file << "\n";
      const std::vector<Vec3> viewpoints = random_viewpoints(scene, random, count);
      const std::vector<float> of_cpu = render_all(*depth::make_cpu_depth_renderer(scene), viewpoints, size, sampling);
      for (std::size_t i = 0; i < list_.opengl.size(); ++i) {
        const auto renderer = depth::make_gl_depth_renderer(scene, list_.opengl[i]);
        compare(render_all(*renderer, viewpoints, size, sampling), of_cpu, size, sums[i]);
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Agreement& sum = sums[i];
      std::cout << list_.opengl[i].device.name << ": " << sum.differing << " of " << sum.texels << " texels ("
                << 100.0 * sum.differing / sum.texels << " %) differ by more than 1e-4, " << sum.farther
                << " are farther; " << sum.hits << " hit something\n";
      EXPECT_GT(sum.hits, sum.texels / 10) << "nothing to compare";
      expect(sum);
    }
  }

  depth::DeviceList list_;
};

TEST_F(HeavyDepthAgreement, OfThousandViewpoints) {
  // Rays on the CPU.
  compare_all(250, 32, Sampling::centers, [](const Agreement& sum) { EXPECT_LT(sum.differing, 0.001 * sum.texels); });
}

TEST_F(HeavyDepthAgreement, OfLargeFaces) {
  // Rasterised on the CPU.
  compare_all(10, 256, Sampling::centers, [](const Agreement& sum) { EXPECT_LT(sum.differing, 0.001 * sum.texels); });
}

TEST_F(HeavyDepthAgreement, OfNearestDepths) {
  // The CPU's are the true nearest depths but for rounding: OpenGL's must not be farther, and may be nearer.
  compare_all(50, 32, Sampling::nearest, [](const Agreement& sum) {
    EXPECT_EQ(sum.farther, 0U);
    EXPECT_LT(sum.differing, 0.5 * sum.texels);
  });
}

}  // namespace
}  // namespace vantage::testing
