// Flights as Python holds them.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mission.h"
#include "vantage/error.h"
#include "vantage/flight.h"

namespace vantage::python {

/// Codes and texts.
using NoteRows = std::vector<std::pair<std::string, std::string>>;

struct PyFlight {
  std::shared_ptr<const Flight> flight;
  NoteRows notes = {};  ///< of the plan that it came from

  const Flight& operator*() const { return *flight; }
  const Flight* operator->() const { return flight.get(); }
};

inline PyFlight py_flight(Flight flight) { return {std::make_shared<const Flight>(std::move(flight))}; }

}  // namespace vantage::python
