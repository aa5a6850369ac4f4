// What the libraries of vantage export; everything else in them is hidden.
#pragma once

#if defined(__GNUC__)
/// Part of the public API.
#define VANTAGE_API __attribute__((visibility("default")))
/// What one component of vantage needs of another one's internals, all in namespace vantage::internal; not for other
/// programs: it may change with any version. tests/exported_internals.txt lists them.
#define VANTAGE_INTERNAL_API __attribute__((visibility("default")))
#else
#define VANTAGE_API
#define VANTAGE_INTERNAL_API
#endif
