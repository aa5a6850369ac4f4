# The libraries: vantage::core and what stands on it, each built where VANTAGE_COMPONENTS names it, and
# vantage::vantage, which is all of them. docs/libraries.md lists them. Shared or static as BUILD_SHARED_LIBS says.

# vantage_component(NAME  MODULES folders of src/...  [HOT more folders: without the standard library's checks, see
# cmake/Options.cmake]  [SOURCES more files]  [LINK targets that an installed static library needs as well]  [BUILD
# targets that only the build needs]  [REQUIRES other components])
function(vantage_component name)
  cmake_parse_arguments(PARSE_ARGV 1 part "" "" "MODULES;HOT;SOURCES;LINK;BUILD;REQUIRES")
  # Compiled once: for the library, and for the tests, which see what is hidden.
  set(objects)
  foreach(kind MODULES HOT)
    set(sources)
    if(kind STREQUAL "MODULES")
      set(sources ${part_SOURCES})
    endif()
    foreach(module IN LISTS part_${kind})
      file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${module}/*.cpp)
      list(APPEND sources ${found})
    endforeach()
    list(FILTER sources EXCLUDE REGEX "/src/core/threads_|/src/app/components/|/tour/linear_program_")
    list(REMOVE_ITEM sources ${VANTAGE_HELPER_SOURCES})
    if(kind STREQUAL "MODULES")
      list(APPEND sources ${part_SOURCES})
    endif()
    list(REMOVE_DUPLICATES sources)
    if(NOT sources)
      continue()
    endif()
    set(target vantage_${name}_objects)
    if(kind STREQUAL "HOT")
      set(target vantage_${name}_hot_objects)
    endif()
    add_library(${target} OBJECT ${sources})
    list(APPEND objects ${target})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
    target_compile_features(${target} PRIVATE cxx_std_20)
    target_link_libraries(${target} PRIVATE
      Eigen3::Eigen fmt::fmt-header-only ${part_LINK} ${part_BUILD} vantage::options)
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    if(kind STREQUAL "HOT")
      target_compile_options(${target} PRIVATE ${VANTAGE_HOT_OPTIONS})
    endif()
    vantage_join_sources(${target})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY VANTAGE_OBJECT_LIBRARIES ${objects})

  list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
  add_library(vantage_${name} ${objects})
  add_library(vantage::${name} ALIAS vantage_${name})
  target_include_directories(vantage_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(vantage_${name} PUBLIC cxx_std_20)
  list(TRANSFORM part_REQUIRES PREPEND vantage_ OUTPUT_VARIABLE required)
  target_link_libraries(vantage_${name} PUBLIC Eigen3::Eigen ${required} PRIVATE ${part_LINK})
  foreach(target IN LISTS part_BUILD)
    target_link_libraries(vantage_${name} PRIVATE $<BUILD_INTERFACE:${target}>)
  endforeach()
  if(BUILD_SHARED_LIBS)
    target_link_libraries(vantage_${name} PRIVATE vantage_helpers)
    if(NOT VANTAGE_SANITIZE)
      target_link_options(vantage_${name} PRIVATE LINKER:--no-undefined)
    endif()
  endif()
  # Until 1.0 a minor version may break programs, as the package version file says too. What a library merely passes on
  # is not linked to it: `core` alone needs few others.
  set_target_properties(vantage_${name} PROPERTIES
    EXPORT_NAME ${name} LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH "$ORIGIN")  # they lie side by side, wherever that is
  target_link_options(vantage_${name} PRIVATE LINKER:--as-needed LINKER:--exclude-libs,ALL)
  target_link_libraries(vantage INTERFACE vantage_${name})
  set_property(GLOBAL APPEND PROPERTY VANTAGE_BUILT_COMPONENTS ${name})
endfunction()

add_library(vantage INTERFACE)
add_library(vantage::vantage ALIAS vantage)
set(source ${PROJECT_SOURCE_DIR}/src)

# Helpers of which every shared library takes in what it uses: they need not be exported. They have no state of their
# own, but for PROJ, which each library then loads for itself.
set(VANTAGE_HELPER_SOURCES)
foreach(file
    core/bvh core/closed_mesh_check core/convex_corners core/edges core/enclosing_circle
    core/exact_crossing core/facet_polygon core/grown_polygon core/limit_check core/mend_welded core/orientation
    core/pieces core/png_mark core/portable_math core/sha256 core/sha256_x86 core/solid_check
    core/stars core/system_limits core/text core/triangle_contact core/triangle_distance
    core/triangle_tree core/weld core/zone_check geo/coordinate_system geo/local_frame
    geo/longitudes geo/proj_files geo/proj_library io/json_text io/write_zip io/zip options/spheres_options
    request/description
    target/lengths target/range_check target/range_region)
  list(APPEND VANTAGE_HELPER_SOURCES ${source}/${file}.cpp)
endforeach()
add_library(vantage_helpers STATIC EXCLUDE_FROM_ALL ${VANTAGE_HELPER_SOURCES})
target_include_directories(vantage_helpers PRIVATE ${PROJECT_SOURCE_DIR}/include ${source})
# PROJ is loaded when it is needed, not linked, but with VANTAGE_LINK_PROJ: src/geo/proj_library.h.
target_include_directories(vantage_helpers SYSTEM PRIVATE ${VANTAGE_PROJ_INCLUDE_DIRS})
set_source_files_properties(${source}/geo/proj_library.cpp PROPERTIES COMPILE_DEFINITIONS "${VANTAGE_PROJ_DEFINITIONS}")
target_link_libraries(vantage_helpers PRIVATE
  ${VANTAGE_PROJ_TARGET} Eigen3::Eigen fmt::fmt-header-only nlohmann_json::nlohmann_json vantage::cdt vantage::options
  ZLIB::ZLIB)
set_target_properties(vantage_helpers PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
vantage_join_sources(vantage_helpers)

vantage_component(core
  MODULES core request options geo io scene target query camera sensor prove simplify
  HOT exact
  SOURCES ${source}/core/threads_${VANTAGE_THREADS}.cpp
  LINK ${VANTAGE_THREAD_TARGETS} ZLIB::ZLIB ${VANTAGE_PROJ_TARGET} ${CMAKE_DL_LIBS}
  BUILD nlohmann_json::nlohmann_json vantage::cdt)
if(NOT BUILD_SHARED_LIBS)
  target_sources(vantage_core PRIVATE $<TARGET_OBJECTS:vantage_helpers>)
endif()

if(VANTAGE_WITH_SOLID)
  if(VANTAGE_INSTALLED_MANIFOLD)
    vantage_component(solid MODULES solid LINK manifold::manifold ${VANTAGE_THREAD_TARGETS} REQUIRES core)
  else()
    vantage_component(solid MODULES solid LINK ${VANTAGE_THREAD_TARGETS} BUILD manifold::manifold REQUIRES core)
    if(NOT BUILD_SHARED_LIBS)
      target_sources(vantage_solid PRIVATE $<TARGET_OBJECTS:manifold>)  # ours is not installed by itself
    endif()
  endif()
endif()
if(VANTAGE_WITH_MAPS)
  vantage_component(maps
    MODULES maps
    LINK EXPAT::EXPAT BZip2::BZip2 ZLIB::ZLIB Threads::Threads PkgConfig::VANTAGE_CLIPPER ${CMAKE_DL_LIBS}
    BUILD vantage::osmium vantage::cdt
    REQUIRES core solid)
endif()
if(VANTAGE_WITH_DEPTH)
  vantage_component(depth MODULES depth spheres LINK embree ${CMAKE_DL_LIBS} REQUIRES core solid)
endif()
if(VANTAGE_WITH_PICTURE)
  vantage_component(picture MODULES picture LINK embree PkgConfig::VANTAGE_CAIRO REQUIRES core depth)
endif()
if(VANTAGE_WITH_VERIFY)
  vantage_component(verify MODULES verify LINK embree REQUIRES core)
endif()
if(VANTAGE_WITH_APP)
  # What missions need of a component that is not built is an error that says so.
  set(app_sources)
  set(app_requires core)
  set(solid_bridge solid)
  set(maps_bridge maps ground_target kml_zones)
  set(depth_bridge spheres run_willis)
  foreach(component solid maps depth)
    string(TOUPPER ${component} name)
    set(files ${${component}_bridge})
    if(VANTAGE_WITH_${name})
      list(APPEND app_requires ${component})
    else()
      list(GET files 0 first)
      set(files without_${first})
    endif()
    list(TRANSFORM files REPLACE "(.+)" "${source}/app/components/\\1.cpp")
    list(APPEND app_sources ${files})
  endforeach()
  set(app_libraries yaml-cpp ZLIB::ZLIB)  # the second for KMZ
  if(VANTAGE_WITH_MAPS)
    list(APPEND app_libraries EXPAT::EXPAT)  # for KML
  endif()
  vantage_component(app MODULES app SOURCES ${app_sources} LINK ${app_libraries} BUILD nlohmann_json::nlohmann_json
                    REQUIRES ${app_requires})
endif()
if(VANTAGE_WITH_FLIGHT)
  set(solver none)  # of linear programs
  set(solver_library)
  if(VANTAGE_HAS_HIGHS)
    set(solver highs)
    set(solver_library highs::highs)
  endif()
  vantage_component(flight
    MODULES flight SOURCES ${source}/flight/tour/linear_program_${solver}.cpp
    LINK EXPAT::EXPAT ZLIB::ZLIB BUILD nlohmann_json::nlohmann_json ${solver_library} REQUIRES core solid app)
  if(VANTAGE_HAS_HIGHS AND NOT BUILD_SHARED_LIBS)
    target_sources(vantage_flight PRIVATE $<TARGET_OBJECTS:vantage_highs>)  # it is not installed by itself
  endif()
endif()
get_property(VANTAGE_BUILT_COMPONENTS GLOBAL PROPERTY VANTAGE_BUILT_COMPONENTS)

# All that is hidden, for tests and fuzz targets only.
get_property(objects GLOBAL PROPERTY VANTAGE_OBJECT_LIBRARIES)
list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
add_library(vantage_inside STATIC EXCLUDE_FROM_ALL ${objects} $<TARGET_OBJECTS:vantage_helpers>)
foreach(component IN LISTS VANTAGE_BUILT_COMPONENTS)
  target_link_libraries(vantage_inside PUBLIC $<TARGET_PROPERTY:vantage_${component}_objects,LINK_LIBRARIES>)
endforeach()
target_include_directories(vantage_inside PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
