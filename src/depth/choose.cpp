// The one place that chooses among the back ends, and that goes on with the CPU where a device fails.
#include "depth/choose.h"

#include <algorithm>
#include <utility>

#include "depth/cpu_depth.h"
#include "depth/device_list.h"
#include "depth/gl_depth.h"
#include "vantage/error.h"

namespace vantage::internal::depth {
namespace {

constexpr const char* kWhere = "choosing a device";

/// "0: CPU (Embree 3.13.5); 1: llvmpipe".
std::string list_of(const RenderDevices& found) {
  std::string text;
  for (const RenderDevice& device : found.devices) {
    text += (text.empty() ? "" : "; ") + std::to_string(device.index) + ": " + device.name;
  }
  return text;
}

const RenderDevice* first_of(const RenderDevices& found, DeviceKind kind) {
  const auto at = std::find_if(found.devices.begin(), found.devices.end(),
                               [kind](const RenderDevice& device) { return device.kind == kind; });
  return at == found.devices.end() ? nullptr : &*at;
}

[[noreturn]] void throw_not_there(const RenderDevices& found, const std::string& problem, const std::string& advice) {
  const std::string reason = found.why_no_opengl.empty() ? "" : ": " + found.why_no_opengl;
  throw Error(ErrorCode::device_missing, problem + reason, std::string(kWhere) + "; there is " + list_of(found),
              advice);
}

std::string why_the_cpu(const RenderDevices& found) {
  const RenderDevice* software = first_of(found, DeviceKind::opengl_software);
  if (software) return "no graphics processor: the OpenGL here, " + software->name + ", runs on the processor itself";
  return found.why_no_opengl;
}

bool insists(const DeviceChoice& choice) { return choice.kind != DeviceChoice::Kind::automatic; }

Error insisted_failure(const RenderDevice& device, const DeviceFailure& failure) {
  return {
      ErrorCode::device_failed, std::string("the device cannot go on: ") + failure.what(), "device " + device.name,
      "take another device (--device), --device auto, which falls back to the CPU, smaller faces, or a smaller scene"};
}

/// Renders with one device until it fails, then with the CPU.
class FallbackRenderer : public DepthRenderer {
 public:
  FallbackRenderer(std::unique_ptr<DepthRenderer> renderer, const BackEnds& back_ends, bool insisting)
      : renderer_(std::move(renderer)), back_ends_(back_ends), is_insisting_(insisting) {}

  const RenderDevice& device() const override { return renderer_->device(); }

  void render(const DepthRequest& request, const DepthSink& sink) override {
    const bool is_last = renderer_->device().kind == DeviceKind::cpu;
    if (!is_last && !is_insisting_ && request.face_size > renderer_->device().largest_face_size) use_cpu();
    std::size_t done = 0;
    try {
      renderer_->render(request, [&](std::size_t viewpoint, std::span<const float> inverse_depths) {
        sink(viewpoint, inverse_depths);
        done = viewpoint + 1;
      });
      return;
    } catch (const DeviceFailure& failure) {
      if (is_last || is_insisting_) throw insisted_failure(renderer_->device(), failure);
    }
    use_cpu();
    DepthRequest rest = request;
    rest.viewpoints = request.viewpoints.subspan(done);
    renderer_->render(rest, [&](std::size_t viewpoint, std::span<const float> inverse_depths) {
      sink(done + viewpoint, inverse_depths);
    });
  }

 private:
  void use_cpu() {
    renderer_.reset();  // first its memory
    renderer_ = back_ends_.make(back_ends_.found.devices.front());
  }

  std::unique_ptr<DepthRenderer> renderer_;
  BackEnds back_ends_;
  bool is_insisting_;
};

}  // namespace

ChosenRenderer make_depth_renderer(const BackEnds& back_ends, const DeviceChoice& choice) {
  ChosenDevice chosen = choose_device(back_ends.found, choice);
  std::unique_ptr<DepthRenderer> renderer;
  try {
    renderer = back_ends.make(chosen.device);
  } catch (const DeviceFailure& failure) {
    if (insists(choice)) throw insisted_failure(chosen.device, failure);
    chosen.note = chosen.device.name + " cannot be used: " + failure.what();
    renderer = back_ends.make(back_ends.found.devices.front());
  }
  return {std::make_unique<FallbackRenderer>(std::move(renderer), back_ends, insists(choice)), std::move(chosen.note)};
}

ChosenRenderer make_depth_renderer(const PreparedScene& scene, const DeviceChoice& choice) {
  DeviceList list;
  // Looking for OpenGL takes a while, and changes nothing where the CPU is asked for.
  if (choice.kind == DeviceChoice::Kind::cpu) {
    list.found.devices.push_back(cpu_device());
  } else {
    list = list_devices();
  }
  BackEnds back_ends;
  back_ends.found = list.found;
  back_ends.make = [scene, opengl = std::move(list.opengl)](const RenderDevice& device) {
    if (device.kind == DeviceKind::cpu) return make_cpu_depth_renderer(scene);
    return make_gl_depth_renderer(scene, opengl.at(device.index - 1));
  };
  return make_depth_renderer(back_ends, choice);
}

}  // namespace vantage::internal::depth

namespace vantage {

using namespace internal::depth;

ChosenDevice choose_device(const RenderDevices& found, const DeviceChoice& choice) {
  const RenderDevice& cpu = found.devices.front();
  const RenderDevice* hardware = first_of(found, DeviceKind::opengl_hardware);
  const RenderDevice* software = first_of(found, DeviceKind::opengl_software);
  switch (choice.kind) {
    case DeviceChoice::Kind::automatic:
      if (hardware) return {*hardware, ""};
      return {cpu, why_the_cpu(found)};
    case DeviceChoice::Kind::cpu:
      return {cpu, ""};
    case DeviceChoice::Kind::opengl:
      if (hardware) return {*hardware, ""};
      if (software) return {*software, ""};
      throw_not_there(found, "there is no OpenGL device", "install what is missing, or take --device auto or cpu");
    case DeviceChoice::Kind::gpu:
      if (hardware) return {*hardware, ""};
      throw_not_there(found, "there is no graphics processor",
                      "install its driver with EGL, or take --device auto, cpu or opengl");
    case DeviceChoice::Kind::index:
      for (const RenderDevice& device : found.devices) {
        if (device.index == choice.index) return {device, ""};
      }
      throw_not_there(found, "there is no device " + std::to_string(choice.index),
                      "take one of those, or --device auto; 'vantage devices' lists them");
  }
  throw Error(ErrorCode::internal_defect, "an unknown choice of device", kWhere, "");
}

}  // namespace vantage
