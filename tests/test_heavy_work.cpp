// What took far too long.
#include <gtest/gtest.h>

#include <string>

#include "support/random.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

// An outline of 60 teeth under 1,500 triangles. Without a limit it did not end in two minutes, and a tenth of the limit
// that missions have by themselves ends it in a tenth of the time.
TEST(HeavyWork, AnOutlineOfManyTeethIsBounded) {
  const testing::TemporaryDirectory folder;
  testing::Random random(2251);
  std::string text = "o ground\nv -90 -90 0\nv 90 -90 0\nv 90 90 0\nv -90 90 0\nf 1 2 3 4\no soup\n";
  for (int i = 0; i < 1500; ++i) {
    const Vec3 at = random.point(-40, 40).cwiseProduct(Vec3(1, 1, 0.4)) + Vec3(0, 0, 20);
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = at + random.point(-1, 1);
      text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
    }
    text += "f -3 -2 -1\n";
  }
  testing::write_bytes(folder / "soup.obj", text);
  std::string outline = "[-6, -3], [6, -3]";
  constexpr int kTeeth = 60;
  for (int i = kTeeth - 1; i >= 0; --i) {
    const double x = -6 + 0.2 * i;
    for (const auto& [at, y] :
         {std::pair(x + 0.18, -2), std::pair(x + 0.1, -2), std::pair(x + 0.08, 3), std::pair(x, 3)}) {
      outline += ", [" + std::to_string(at) + ", " + std::to_string(y) + "]";
    }
  }
  testing::write_bytes(folder / "comb.yaml",
                       "scene: {mesh: soup.obj}\nsensor: {max_range: 55}\nwork_limit: 1.0e+6\n"
                       "target: {outline: [" +
                           outline + "], offset: 0.5}\n");
  const Mission mission = resolve_mission(read_mission(folder / "comb.yaml"));
  EXPECT_GT(mission.target.parts.size(), 60U);
  testing::expect_code([&] { run_mission(mission); }, ErrorCode::work_too_large);
}

}  // namespace
}  // namespace vantage
