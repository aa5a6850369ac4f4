// Which device renders, and what happens when it fails: with renderers that fail on purpose.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "depth/choose.h"
#include "support/mesh_reading.h"
#include "support/scenes.h"
#include "vantage/error.h"

namespace vantage::testing {
namespace {

using depth::BackEnds;
using depth::ChosenRenderer;
using depth::DepthRequest;
using depth::DeviceFailure;
using Kind = DeviceChoice::Kind;

RenderDevice device(int index, DeviceKind kind, const std::string& name) {
  RenderDevice result;
  result.index = index;
  result.kind = kind;
  result.name = name;
  result.largest_face_size = kind == DeviceKind::cpu ? 8192 : 100;
  return result;
}

/// Answers each viewpoint with its x and the number of its device; fails once so many have been answered.
class FakeRenderer : public depth::DepthRenderer {
 public:
  FakeRenderer(const RenderDevice& device, std::size_t answers) : device_(device), answers_(answers) {}
  const RenderDevice& device() const override { return device_; }
  void render(const DepthRequest& request, const depth::DepthSink& sink) override {
    EXPECT_LE(request.face_size, device_.largest_face_size);
    for (std::size_t i = 0; i < request.viewpoints.size(); ++i) {
      if (answers_ == 0) throw DeviceFailure("the driver reset the device");
      --answers_;
      const std::vector<float> image{static_cast<float>(request.viewpoints[i].x()), static_cast<float>(device_.index)};
      sink(i, image);
    }
  }

 private:
  RenderDevice device_;
  std::size_t answers_;
};

struct Machine {
  bool software = true, hardware = true;
  bool fails_at_once = false;  ///< making a renderer for a graphics processor fails
  std::size_t answers = 1000;  ///< of the graphics processor, before it is lost
  std::vector<std::string> made{};

  BackEnds back_ends() {
    BackEnds result;
    int index = 0;
    result.found.devices.push_back(device(index++, DeviceKind::cpu, "CPU"));
    if (software) result.found.devices.push_back(device(index++, DeviceKind::opengl_software, "llvmpipe"));
    if (hardware) result.found.devices.push_back(device(index++, DeviceKind::opengl_hardware, "Big GPU"));
    if (!software && !hardware) result.found.why_no_opengl = "libEGL.so.1 is not installed";
    result.make = [this](const RenderDevice& of) -> std::unique_ptr<depth::DepthRenderer> {
      if (of.kind != DeviceKind::cpu && fails_at_once) throw DeviceFailure("the scene needs 9 GiB of 8");
      made.push_back(of.name);
      return std::make_unique<FakeRenderer>(of, of.kind == DeviceKind::cpu ? 1000 : answers);
    };
    return result;
  }
};

const std::vector<Vec3> kEyes{{10, 0, 0}, {11, 0, 0}, {12, 0, 0}, {13, 0, 0}, {14, 0, 0}};

/// Renders kEyes; the devices that did, in order. Every viewpoint must come once and in its place.
std::vector<int> devices_of(depth::DepthRenderer& renderer, int face_size = 8) {
  std::vector<int> result;
  renderer.render({kEyes, face_size, depth::Sampling::centers, 10}, [&](std::size_t i, std::span<const float> image) {
    ASSERT_EQ(i, result.size());
    ASSERT_EQ(image[0], static_cast<float>(kEyes[i].x()));
    result.push_back(static_cast<int>(image[1]));
  });
  return result;
}

std::string chosen(Machine machine, Kind kind, int index = 0) {
  return depth::make_depth_renderer(machine.back_ends(), {kind, index}).renderer->device().name;
}

TEST(ChooseDevice, AutomaticTakesAGraphicsProcessorOrElseTheCpu) {
  EXPECT_EQ(chosen({}, Kind::automatic), "Big GPU");
  EXPECT_EQ(chosen({.hardware = false}, Kind::automatic), "CPU");
  EXPECT_EQ(chosen({.software = false, .hardware = false}, Kind::automatic), "CPU");
}

TEST(ChooseDevice, SaysWhyItIsTheCpu) {
  Machine neither{.software = false, .hardware = false}, emulated{.hardware = false}, full;
  const auto note = [](Machine& machine, Kind kind) {
    return depth::make_depth_renderer(machine.back_ends(), {kind, 0}).note;
  };
  testing::expect_wording(note(neither, Kind::automatic));
  EXPECT_NE(note(emulated, Kind::automatic).find("llvmpipe"), std::string::npos);
  EXPECT_EQ(note(full, Kind::automatic), "");
  EXPECT_EQ(note(full, Kind::cpu), "");
}

TEST(ChooseDevice, TakesWhatIsAskedFor) {
  EXPECT_EQ(chosen({}, Kind::cpu), "CPU");
  EXPECT_EQ(chosen({}, Kind::opengl), "Big GPU");
  EXPECT_EQ(chosen({.hardware = false}, Kind::opengl), "llvmpipe");
  EXPECT_EQ(chosen({}, Kind::gpu), "Big GPU");
  EXPECT_EQ(chosen({}, Kind::index, 0), "CPU");
  EXPECT_EQ(chosen({}, Kind::index, 1), "llvmpipe");
  EXPECT_EQ(chosen({}, Kind::index, 2), "Big GPU");
}

TEST(ChooseDevice, RefusesWhatIsNotThereAndSaysWhatIs) {
  expect_error([] { chosen({.hardware = false}, Kind::gpu); }, ErrorCode::device_missing, "0: CPU; 1: llvmpipe");
  expect_error([] { chosen({.software = false, .hardware = false}, Kind::opengl); }, ErrorCode::device_missing,
               "0: CPU");
  expect_error([] { chosen({}, Kind::index, 3); }, ErrorCode::device_missing, "2: Big GPU");
  expect_error([] { chosen({}, Kind::index, -1); }, ErrorCode::device_missing, "2: Big GPU");
}

TEST(ChooseDevice, FallsBackWhenTheDeviceCannotHoldTheScene) {
  Machine machine{.fails_at_once = true};
  ChosenRenderer chosen = depth::make_depth_renderer(machine.back_ends(), {});
  EXPECT_EQ(chosen.renderer->device().kind, DeviceKind::cpu);
  testing::expect_wording(chosen.note);
  EXPECT_EQ(devices_of(*chosen.renderer), (std::vector<int>{0, 0, 0, 0, 0}));
  expect_error(
      [&] {
        depth::make_depth_renderer(machine.back_ends(), {Kind::gpu, 0});
      },
      ErrorCode::device_failed, "Big GPU");
}

TEST(ChooseDevice, GoesOnWithTheCpuInTheMiddleOfARequest) {
  for (const std::size_t answers : {0U, 1U, 3U, 4U}) {
    Machine machine{.answers = answers};
    ChosenRenderer chosen = depth::make_depth_renderer(machine.back_ends(), {});
    EXPECT_EQ(chosen.renderer->device().name, "Big GPU");
    std::vector<int> expected(answers, 2);
    expected.resize(kEyes.size(), 0);
    EXPECT_EQ(devices_of(*chosen.renderer), expected);
    EXPECT_EQ(chosen.renderer->device().name, "CPU");
    EXPECT_EQ(devices_of(*chosen.renderer), (std::vector<int>{0, 0, 0, 0, 0})) << "and stays there";
    EXPECT_EQ(machine.made, (std::vector<std::string>{"Big GPU", "CPU"}));
  }
}

TEST(ChooseDevice, StopsInTheMiddleWhereTheChoiceInsists) {
  for (const DeviceChoice& choice :
       {DeviceChoice{Kind::gpu, 0}, DeviceChoice{Kind::opengl, 0}, DeviceChoice{Kind::index, 2}}) {
    Machine machine{.answers = 2};
    ChosenRenderer chosen = depth::make_depth_renderer(machine.back_ends(), choice);
    expect_error([&] { devices_of(*chosen.renderer); }, ErrorCode::device_failed, "Big GPU");
  }
}

TEST(ChooseDevice, TakesTheCpuForFacesThatTheDeviceDoesNotMake) {
  Machine machine;
  ChosenRenderer chosen = depth::make_depth_renderer(machine.back_ends(), {});
  EXPECT_EQ(devices_of(*chosen.renderer, 101), (std::vector<int>{0, 0, 0, 0, 0}));
}

TEST(ChooseDevice, LetsErrorsOfTheSinkThrough) {
  Machine machine;
  ChosenRenderer chosen = depth::make_depth_renderer(machine.back_ends(), {});
  const auto stop = [](std::size_t, std::span<const float>) { throw Error(ErrorCode::cancelled, "stop", "", ""); };
  EXPECT_THROW(chosen.renderer->render({kEyes, 8, depth::Sampling::centers, 10}, stop), Error);
  EXPECT_EQ(machine.made, (std::vector<std::string>{"Big GPU"})) << "no fault of the device";
}

TEST(ChooseDevice, OfThisMachineRendersARealScene) {
  const PreparedScene scene(SceneBuilder().box("room", {-2, -3, -4}, {5, 6, 7}));
  for (const Kind kind : {Kind::automatic, Kind::cpu}) {
    const ChosenRenderer chosen = depth::make_depth_renderer(scene, {kind, 0});
    const Vec3 eye(0, 0, 0);
    int calls = 0;
    chosen.renderer->render({{&eye, 1}, 3, depth::Sampling::nearest, 100},
                            [&](std::size_t, std::span<const float> image) {
                              ++calls;
                              ASSERT_EQ(image.size(), 54U);
                              EXPECT_NEAR(image[4], 1 / 5.0, 1e-6);
                            });
    EXPECT_EQ(calls, 1);
  }
}

TEST(RenderDevices, BeginWithTheCpuAndAreNumbered) {
  const RenderDevices found = render_devices();
  ASSERT_FALSE(found.devices.empty());
  EXPECT_EQ(found.devices[0].kind, DeviceKind::cpu);
  for (std::size_t i = 0; i < found.devices.size(); ++i) {
    EXPECT_EQ(found.devices[i].index, static_cast<int>(i));
    EXPECT_FALSE(found.devices[i].name.empty());
    EXPECT_GE(found.devices[i].largest_face_size, 1024);
  }
  EXPECT_EQ(found.why_no_opengl.empty(), found.devices.size() > 1);
}

TEST(DeviceChoice, IsParsed) {
  EXPECT_EQ(parse_device_choice("auto").kind, Kind::automatic);
  EXPECT_EQ(parse_device_choice("cpu").kind, Kind::cpu);
  EXPECT_EQ(parse_device_choice("opengl").kind, Kind::opengl);
  EXPECT_EQ(parse_device_choice("gpu").kind, Kind::gpu);
  EXPECT_EQ(parse_device_choice("12").kind, Kind::index);
  EXPECT_EQ(parse_device_choice("12").index, 12);
  for (const char* wrong : {"", "GPU", "-1", "1.5", "1 ", "99999999999", "cuda"}) {
    expect_error([&] { parse_device_choice(wrong); }, ErrorCode::unknown_choice, "--device");
  }
}

}  // namespace
}  // namespace vantage::testing
