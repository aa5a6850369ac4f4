#include <memory>

#include "cli/command.h"
#include "cli/text_table.h"
#include "common/json.h"
#include "vantage/devices.h"

namespace vantage::cli {
namespace {

constexpr const char* kDevicesExamples =
    "EXAMPLES\n"
    "  vantage devices\n"
    "  vantage devices --device gpu        # is there a graphics processor? exit code 2 when not\n"
    "  vantage devices --json | jq -r '.devices[].name'\n";

struct DevicesArguments {
  CommonOptions common;
  std::string device = "auto";
  bool json = false;
};

const char* kind_remark(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::cpu:
      return "ray casting on the processor; always there";
    case DeviceKind::opengl_software:
      return "OpenGL that the processor emulates";
    case DeviceKind::opengl_hardware:
      return "OpenGL on a graphics processor";
  }
  return "";
}

std::string why(const ChosenDevice& chosen, const std::string& asked) {
  if (!chosen.note.empty()) return chosen.note;
  return asked == "auto" ? "the first graphics processor" : "asked for by --device " + asked;
}

std::string table_text(const RenderDevices& found, const ChosenDevice& chosen, const std::string& reason) {
  TextTable table;
  for (const RenderDevice& device : found.devices) {
    table.heading("device " + std::to_string(device.index) + ": " + device.name);
    table.row("kind", "", kind_remark(device.kind));
    if (!device.driver.empty()) table.row("driver", "", device.driver);
    if (device.memory_bytes > 0) {
      table.row("memory", fixed(static_cast<double>(device.memory_bytes) / (1 << 30), 1), "GiB of its own");
    } else {
      table.row("memory", "",
                device.kind == DeviceKind::opengl_hardware ? "the driver does not say how much" : "main memory");
    }
    table.row("faces up to", count(static_cast<std::size_t>(device.largest_face_size)), "texels a side");
  }
  if (!found.why_no_opengl.empty()) {
    table.heading("more devices");
    table.row("none", "", found.why_no_opengl);
  }
  table.heading("would be used");
  table.row("device", std::to_string(chosen.device.index), reason);
  return table.text();
}

int run_devices(const DevicesArguments& options) {
  const DeviceChoice choice = parse_device_choice(options.device);
  const RenderDevices found = render_devices();
  const ChosenDevice chosen = choose_device(found, choice);
  const std::string reason = why(chosen, options.device);
  print(options.json ? json_text(found, chosen, reason) : table_text(found, chosen, reason));
  return kSuccess;
}

}  // namespace

void add_devices(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("devices", "Show what can render depth images and pictures here, and which would be used");
  auto options = std::make_shared<DevicesArguments>();
  command
      ->add_option("--device", options->device,
                   "Device to choose: auto (default), cpu, opengl, gpu, or the number of a device")
      ->option_text("DEVICE");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<DevicesArguments>(*command, options, kDevicesExamples, chosen, run_devices);
}

}  // namespace vantage::cli
