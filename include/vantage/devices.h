// What can render depth images and pictures on this machine.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vantage/export.h"

namespace vantage {

enum class DeviceKind {
  cpu,              ///< ray casting on the processor (Embree); always there
  opengl_software,  ///< OpenGL that the processor emulates (Mesa's llvmpipe)
  opengl_hardware,  ///< OpenGL on a graphics processor
};

/// "cpu", "opengl_software", "opengl_hardware".
VANTAGE_API const char* name_of(DeviceKind kind);

struct RenderDevice {
  int index = 0;  ///< in the list of render_devices: what `--device 1` names
  DeviceKind kind = DeviceKind::cpu;
  std::string name;    ///< "NVIDIA H200", "llvmpipe (LLVM 15.0.6, 256 bits)", "CPU (Embree 3.13.5)"
  std::string driver;  ///< its version as it states it; empty for the CPU
  /// Of its own memory, what the driver says is there; 0: it does not say, or it uses main memory.
  std::size_t memory_bytes = 0;
  int largest_face_size = 0;  ///< texels a side
};

struct RenderDevices {
  std::vector<RenderDevice> devices;  ///< the CPU first
  std::string why_no_opengl;  ///< a sentence with what to install or mend; empty when there is any OpenGL device
};

/// Looks for devices: loads libEGL at run time, asks for its platforms, opens a context on each device. Never throws
/// for what is missing. Tens of milliseconds.
VANTAGE_API RenderDevices render_devices();

/// Which device to use.
struct DeviceChoice {
  enum class Kind {
    automatic,  ///< the first graphics processor; without one, the CPU
    cpu,
    opengl,  ///< any OpenGL device, a graphics processor first: insists, Error(input) when there is none
    gpu,     ///< a graphics processor: insists
    index,   ///< `index` of render_devices: insists
  };
  Kind kind = Kind::automatic;
  int index = 0;
};

/// "auto", "cpu", "opengl", "gpu" or an index; throws Error(input) for anything else.
VANTAGE_API DeviceChoice parse_device_choice(const std::string& text);

/// Which of the devices found `choice` means, and why it is not a graphics processor where one would hope for it.
struct ChosenDevice {
  RenderDevice device;
  std::string note;
};

/// Throws Error(input), with what is there, when it insists on a device that is not.
VANTAGE_API ChosenDevice choose_device(const RenderDevices& found, const DeviceChoice& choice);

}  // namespace vantage
