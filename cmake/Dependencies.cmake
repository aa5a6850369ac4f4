# What each library is for, its licence and what was weighed against it: docs/dependencies.md.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
add_library(vantage_threads INTERFACE)
add_library(vantage::threads ALIAS vantage_threads)
target_link_libraries(vantage_threads INTERFACE Threads::Threads)
if(VANTAGE_THREADS STREQUAL tbb)
  find_package(TBB 2021 REQUIRED)
  target_link_libraries(vantage_threads INTERFACE TBB::tbb)
  set(VANTAGE_HAS_TBB ON)
else()
  set(VANTAGE_HAS_TBB OFF)
endif()
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(ZLIB REQUIRED)

# Embree 3: the independent check and depth images only (src/verify, src/depth, src/picture).
find_package(embree 3 REQUIRED)
add_library(vantage_embree INTERFACE)
add_library(vantage::embree ALIAS vantage_embree)
target_link_libraries(vantage_embree INTERFACE embree)

# Cairo: writing on pictures, and PNG (src/picture only).
find_package(PkgConfig REQUIRED)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo>=1.16)

# PROJ: coordinate reference systems (src/geo only), found here and loaded at run time. libosmium is headers; it reads
# XML with Expat and unpacks with zlib and bzip2 (src/maps/osm only). Clipper 6.4: outlines in the plane
# (src/maps/city/footprint.cpp only); its package file tells no version.
pkg_check_modules(PROJ REQUIRED IMPORTED_TARGET proj>=9.1)
find_library(VANTAGE_PROJ_LIBRARY proj HINTS ${PROJ_LIBRARY_DIRS} REQUIRED NO_CACHE)
file(REAL_PATH ${VANTAGE_PROJ_LIBRARY} VANTAGE_PROJ_FILE)
# The name that stands for its binary interface: libproj.so.25 of libproj.so.25.9.1.1.
get_filename_component(VANTAGE_PROJ_NAME ${VANTAGE_PROJ_FILE} NAME)
string(REGEX REPLACE "^(lib.*\\.so\\.[0-9]+).*" "\\1" VANTAGE_PROJ_NAME ${VANTAGE_PROJ_NAME})
pkg_check_modules(CLIPPER REQUIRED IMPORTED_TARGET polyclipping)
find_package(EXPAT REQUIRED)
find_package(BZip2 REQUIRED)
find_path(OSMIUM_INCLUDE_DIR osmium/version.hpp REQUIRED)
add_library(vantage_osmium INTERFACE)
add_library(vantage::osmium ALIAS vantage_osmium)
target_include_directories(vantage_osmium SYSTEM INTERFACE ${OSMIUM_INCLUDE_DIR})
target_link_libraries(vantage_osmium INTERFACE EXPAT::EXPAT BZip2::BZip2 ZLIB::ZLIB Threads::Threads)

# Source releases that Debian does not package, fetched by scripts/fetch_sources.sh (pinned by version and hash).
set(VANTAGE_DEPS_DIR ${PROJECT_SOURCE_DIR}/.deps CACHE PATH "Where scripts/fetch_sources.sh puts source releases")

# Manifold 3.5: the first with the ExecutionContext that progress and cancelling need. Its releases misplace a corner now and
# then, so an installed one is used only on request: ours is corrected.
option(VANTAGE_INSTALLED_MANIFOLD "Use an installed Manifold as it is (its booleans go wrong where solids coincide)" OFF)
if(VANTAGE_INSTALLED_MANIFOLD)
  find_package(manifold 3.5 REQUIRED)
else()
  set(manifold_source ${VANTAGE_DEPS_DIR}/manifold)
  if(NOT EXISTS ${manifold_source}/CMakeLists.txt)
    message(FATAL_ERROR "Manifold is not in ${manifold_source}: run scripts/fetch_sources.sh first")
  endif()
  block()  # its options must not reach a project that includes ours
    set(MANIFOLD_CROSS_SECTION OFF)
    set(MANIFOLD_DOWNLOADS OFF)
    set(MANIFOLD_PAR ${VANTAGE_HAS_TBB})
    set(MANIFOLD_TEST OFF)
    set(MANIFOLD_CBIND OFF)
    set(MANIFOLD_PYBIND OFF)
    set(BUILD_SHARED_LIBS OFF)
    add_subdirectory(${manifold_source} ${CMAKE_CURRENT_BINARY_DIR}/third_party/manifold EXCLUDE_FROM_ALL SYSTEM)
  endblock()
  include(${CMAKE_CURRENT_LIST_DIR}/MendManifold.cmake)
  vantage_mend_manifold(${manifold_source})
  if(NOT TARGET manifold::manifold)
    add_library(manifold::manifold ALIAS manifold)
  endif()
endif()

add_library(vantage_cdt INTERFACE)
add_library(vantage::cdt ALIAS vantage_cdt)
if(NOT EXISTS ${VANTAGE_DEPS_DIR}/cdt/include/CDT.h)
  message(FATAL_ERROR "CDT is not in ${VANTAGE_DEPS_DIR}/cdt: run scripts/fetch_sources.sh first")
endif()
target_include_directories(vantage_cdt SYSTEM INTERFACE ${VANTAGE_DEPS_DIR}/cdt/include)
