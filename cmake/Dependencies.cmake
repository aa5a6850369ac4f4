# What is built: `core`, `missions` and `vantage` are the library vantage, each holding more of it than the one before;
# `maps` and `picture` are libraries that stand on all of it.
set(VANTAGE_ALL_COMPONENTS core missions vantage maps picture)
set(wanted ${VANTAGE_COMPONENTS})
if(wanted STREQUAL "all")
  set(wanted ${VANTAGE_ALL_COMPONENTS})
endif()
foreach(component IN LISTS wanted)
  if(NOT component IN_LIST VANTAGE_ALL_COMPONENTS)
    list(JOIN VANTAGE_ALL_COMPONENTS ", " known)
    message(FATAL_ERROR "VANTAGE_COMPONENTS names \"${component}\": choose among ${known}, or all")
  endif()
endforeach()
if("maps" IN_LIST wanted OR "picture" IN_LIST wanted)
  list(APPEND wanted vantage)
endif()
if("vantage" IN_LIST wanted)
  list(APPEND wanted missions)
endif()
set(VANTAGE_HAS_ALL ON)
set(VANTAGE_BUILT_COMPONENTS)
foreach(component IN LISTS VANTAGE_ALL_COMPONENTS)
  string(TOUPPER ${component} name)
  if(component IN_LIST wanted OR component STREQUAL "core")
    set(VANTAGE_WITH_${name} ON)
    list(APPEND VANTAGE_BUILT_COMPONENTS ${component})
  else()
    set(VANTAGE_WITH_${name} OFF)
    set(VANTAGE_HAS_ALL OFF)
  endif()
endforeach()

# What each library is for, its licence and what was weighed against it: docs/dependencies.md.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
set(VANTAGE_THREAD_TARGETS Threads::Threads)
set(VANTAGE_HAS_TBB OFF)
if(VANTAGE_THREADS STREQUAL tbb)
  find_package(TBB 2021 REQUIRED)
  list(APPEND VANTAGE_THREAD_TARGETS TBB::tbb)
  set(VANTAGE_HAS_TBB ON)
endif()
find_package(nlohmann_json 3.11 REQUIRED)
find_package(fmt 9.1 REQUIRED)  # the headers alone: no library is linked
find_package(ZLIB REQUIRED)
if(VANTAGE_WITH_MISSIONS)
  find_package(yaml-cpp REQUIRED)
endif()
if(VANTAGE_HAS_ALL)
  find_package(CLI11 REQUIRED)  # the program
  find_package(Boost 1.74 REQUIRED)  # its server, `vantage view`: the headers of Asio and Beast
endif()

# Embree 3: the independent check and depth images only (src/verify, src/depth, src/picture).
if(VANTAGE_WITH_VANTAGE)
  find_package(embree 3 REQUIRED)
endif()

# Cairo: writing on pictures, and PNG (src/picture only); it draws fonts with FreeType.
find_package(PkgConfig REQUIRED)
if(VANTAGE_WITH_PICTURE)
  pkg_check_modules(VANTAGE_CAIRO REQUIRED IMPORTED_TARGET cairo>=1.16 cairo-ft freetype2)
endif()

# PROJ: coordinate reference systems (src/geo only), found here and loaded at run time, or linked. In a browser there is
# none: what includes vantage says in VANTAGE_PROJ_INCLUDE_DIRS where its headers are.
if(NOT EMSCRIPTEN)
  pkg_check_modules(VANTAGE_PROJ REQUIRED IMPORTED_TARGET proj>=9.1)
endif()
option(VANTAGE_LINK_PROJ "Link PROJ, instead of loading it for the first scene that has a place on the earth" OFF)
if(EMSCRIPTEN)
  set(VANTAGE_PROJ_DEFINITIONS VANTAGE_PROJ_ABSENT)
elseif(VANTAGE_LINK_PROJ)
  set(VANTAGE_PROJ_TARGET PkgConfig::VANTAGE_PROJ)
  set(VANTAGE_PROJ_DEFINITIONS VANTAGE_PROJ_LINKED)
else()
  find_library(VANTAGE_PROJ_LIBRARY proj HINTS ${VANTAGE_PROJ_LIBRARY_DIRS} REQUIRED NO_CACHE)
  file(REAL_PATH ${VANTAGE_PROJ_LIBRARY} VANTAGE_PROJ_FILE)
  # The name that stands for its binary interface: libproj.so.25 of libproj.so.25.9.1.1.
  get_filename_component(VANTAGE_PROJ_NAME ${VANTAGE_PROJ_FILE} NAME)
  string(REGEX REPLACE "^(lib.*\\.so\\.[0-9]+).*" "\\1" VANTAGE_PROJ_NAME ${VANTAGE_PROJ_NAME})
  set(VANTAGE_PROJ_DEFINITIONS "VANTAGE_PROJ_NAME=\"${VANTAGE_PROJ_NAME}\";VANTAGE_PROJ_FILE=\"${VANTAGE_PROJ_FILE}\"")
endif()

# Draco and meshoptimizer: compressed meshes in glTF (src/io/draco_library.cpp and meshopt_library.cpp only). Where one is
# not installed vantage is built without it, and says so of a file that needs it.
option(VANTAGE_WITH_DRACO "Read glTF that is compressed with Draco, where it is installed" ON)
option(VANTAGE_WITH_MESHOPT "Read glTF that is compressed with meshoptimizer, where it is installed" ON)
set(VANTAGE_DRACO none)
set(VANTAGE_MESHOPT none)
set(VANTAGE_CODEC_TARGETS)
if(VANTAGE_WITH_DRACO AND NOT EMSCRIPTEN)
  find_package(draco QUIET)
  if(draco_FOUND)
    set(VANTAGE_DRACO library)
    list(APPEND VANTAGE_CODEC_TARGETS draco::draco)
  endif()
endif()
if(VANTAGE_WITH_MESHOPT AND NOT EMSCRIPTEN)
  find_package(meshoptimizer QUIET)
  if(meshoptimizer_FOUND)
    set(VANTAGE_MESHOPT library)
    list(APPEND VANTAGE_CODEC_TARGETS meshoptimizer::meshoptimizer)
  endif()
endif()

if(VANTAGE_WITH_VANTAGE)
  find_package(EXPAT REQUIRED)  # KML and GPX too
endif()

# libosmium is headers; it reads XML with Expat and unpacks with zlib and bzip2 (src/maps/osm only). Clipper 6.4: outlines in
# the plane (src/maps/city/clipping.cpp only); its package file tells no version.
if(VANTAGE_WITH_MAPS)
  pkg_check_modules(VANTAGE_CLIPPER REQUIRED IMPORTED_TARGET polyclipping)
  find_package(BZip2 REQUIRED)
  find_path(OSMIUM_INCLUDE_DIR osmium/version.hpp REQUIRED)
  add_library(vantage_osmium INTERFACE)
  add_library(vantage::osmium ALIAS vantage_osmium)
  target_include_directories(vantage_osmium SYSTEM INTERFACE ${OSMIUM_INCLUDE_DIR})
  target_link_libraries(vantage_osmium INTERFACE EXPAT::EXPAT BZip2::BZip2 ZLIB::ZLIB Threads::Threads)
endif()

# Source releases that Debian does not package, fetched by scripts/fetch_sources.sh (pinned by version and hash).
set(VANTAGE_DEPS_DIR ${PROJECT_SOURCE_DIR}/.deps CACHE PATH "Where scripts/fetch_sources.sh puts source releases")
if(SKBUILD)  # pip: there is no step before this one
  execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/fetch_sources.sh COMMAND_ERROR_IS_FATAL ANY)
endif()

# Manifold 3.5: the first with the ExecutionContext that progress and cancelling need. Its releases misplace a corner now and
# then, so an installed one is used only on request: ours is corrected.
if(VANTAGE_WITH_MISSIONS)
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
    vantage_join_sources(manifold 8)  # names of some of its sources are the same
    if(NOT TARGET manifold::manifold)
      add_library(manifold::manifold ALIAS manifold)
    endif()
  endif()
endif()

# HiGHS: linear programs, for one of the two bounds of tours (src/flight/tour/linear_program_highs.cpp only).
option(VANTAGE_WITH_HIGHS "Build HiGHS, for the bound of tours by pairs" ON)
set(VANTAGE_HAS_HIGHS OFF)
if(VANTAGE_WITH_VANTAGE AND VANTAGE_WITH_HIGHS)
  include(${CMAKE_CURRENT_LIST_DIR}/Highs.cmake)
  vantage_add_highs(${VANTAGE_DEPS_DIR}/highs)
  set(VANTAGE_HAS_HIGHS ON)
endif()

add_library(vantage_cdt INTERFACE)
add_library(vantage::cdt ALIAS vantage_cdt)
if(NOT EXISTS ${VANTAGE_DEPS_DIR}/cdt/include/CDT.h)
  message(FATAL_ERROR "CDT is not in ${VANTAGE_DEPS_DIR}/cdt: run scripts/fetch_sources.sh first")
endif()
target_include_directories(vantage_cdt SYSTEM INTERFACE ${VANTAGE_DEPS_DIR}/cdt/include)
