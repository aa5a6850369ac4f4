// The modules of vantage::internal by their short names: tests and benchmarks look behind the public API.
#pragma once

namespace vantage {
namespace internal {
namespace app {}
namespace arrangement {}
namespace city {}
namespace core {}
namespace depth {}
namespace exact {}
namespace geo {}
namespace io {}
namespace numerics {}
namespace options {}
namespace osm {}
namespace parallel {}
namespace picture {}
namespace query {}
namespace scene {}
namespace solid {}
namespace spheres {}
namespace target {}
namespace terrain {}
namespace verify {}
}  // namespace internal

namespace app = internal::app;
namespace arrangement = internal::arrangement;
namespace city = internal::city;
namespace core = internal::core;
namespace depth = internal::depth;
namespace exact = internal::exact;
namespace geo = internal::geo;
namespace io = internal::io;
namespace numerics = internal::numerics;
namespace options = internal::options;
namespace osm = internal::osm;
namespace parallel = internal::parallel;
namespace picture = internal::picture;
namespace query = internal::query;
namespace scene = internal::scene;
namespace solid = internal::solid;
namespace spheres = internal::spheres;
namespace target = internal::target;
namespace terrain = internal::terrain;
namespace verify = internal::verify;

}  // namespace vantage
