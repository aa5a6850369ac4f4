# The libraries: vantage, and vantage_maps and vantage_picture, which stand on it. VANTAGE_COMPONENTS says which are built,
# and how much of the first. docs/libraries.md lists them. Shared or static as BUILD_SHARED_LIBS says.
set(source ${PROJECT_SOURCE_DIR}/src)

# Sources of src/core that are for another system than this one: those in windows/ stand for others.
if(WIN32)
  set(VANTAGE_OTHER_SYSTEM
      "/src/core/(file_locks|replace_folder|system_files|system_limits|temporary_(file|folder|mark))\\.cpp$")
else()
  set(VANTAGE_OTHER_SYSTEM "/src/core/windows/")
endif()

# vantage_part(NAME  MODULES folders of src/...  [HOT more folders: without the standard library's checks, see
# cmake/Options.cmake]  [OF_LIMITS prove ...: src/limits/*/prove*.cpp]  [SOURCES more files]  [LINK targets that an installed static library needs as well]  [BUILD
# targets that only the build needs]): a part of a library. Compiled once: for the library, and for the tests, which see
# what is hidden.
function(vantage_part name)
  cmake_parse_arguments(PARSE_ARGV 1 part "" "" "MODULES;HOT;OF_LIMITS;SOURCES;LINK;BUILD")
  set(objects)
  foreach(kind MODULES HOT)
    set(sources)
    foreach(module IN LISTS part_${kind})
      file(GLOB_RECURSE found CONFIGURE_DEPENDS ${source}/${module}/*.cpp)
      list(APPEND sources ${found})
    endforeach()
    # Of these there is one for each choice: SOURCES names the one that is taken.
    list(FILTER sources EXCLUDE REGEX "/src/core/threads_|/src/io/(draco|meshopt)_|/src/app/(kml_zones_|verify_mission)|/tour/linear_program_")
    list(FILTER sources EXCLUDE REGEX ${VANTAGE_OTHER_SYSTEM})
    if(kind STREQUAL "MODULES")
      list(APPEND sources ${part_SOURCES})
      foreach(layer IN LISTS part_OF_LIMITS)
        file(GLOB found CONFIGURE_DEPENDS ${source}/limits/*/${layer}*.cpp)
        list(APPEND sources ${found})
      endforeach()
    endif()
    if(NOT sources)
      continue()
    endif()
    set(target vantage_${name}_objects)
    if(kind STREQUAL "HOT")
      set(target vantage_${name}_hot_objects)
    endif()
    add_library(${target} OBJECT ${sources})
    list(APPEND objects ${target})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include ${source})
    target_compile_features(${target} PRIVATE cxx_std_20)
    target_link_libraries(${target} PRIVATE
      Eigen3::Eigen fmt::fmt-header-only ${part_LINK} ${part_BUILD} vantage::options)
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    if(kind STREQUAL "HOT")
      target_compile_options(${target} PRIVATE ${VANTAGE_HOT_OPTIONS})
    endif()
    vantage_join_sources(${target})
  endforeach()
  foreach(list objects part_LINK part_BUILD)
    set_property(GLOBAL PROPERTY VANTAGE_${name}_${list} ${${list}})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY VANTAGE_PARTS ${name})
endfunction()

# vantage_library(TARGET NAME  PARTS ...  [REQUIRES other libraries]): vantage::NAME, of these parts.
function(vantage_library target name)
  cmake_parse_arguments(PARSE_ARGV 2 library "" "" "PARTS;REQUIRES")
  set(objects)
  set(link)
  set(build)
  foreach(part IN LISTS library_PARTS)
    get_property(more GLOBAL PROPERTY VANTAGE_${part}_objects)
    list(APPEND objects ${more})
    get_property(more GLOBAL PROPERTY VANTAGE_${part}_part_LINK)
    list(APPEND link ${more})
    get_property(more GLOBAL PROPERTY VANTAGE_${part}_part_BUILD)
    list(APPEND build ${more})
  endforeach()
  list(REMOVE_DUPLICATES link)
  list(REMOVE_DUPLICATES build)
  list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
  add_library(${target} ${objects})
  add_library(vantage::${name} ALIAS ${target})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen ${library_REQUIRES} PRIVATE ${link})
  foreach(only IN LISTS build)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:${only}>)
  endforeach()
  if(BUILD_SHARED_LIBS AND NOT VANTAGE_SANITIZE)
    target_link_options(${target} PRIVATE LINKER:--no-undefined)
  endif()
  # Until 1.0 a minor version may break programs, as the package version file says too. What a library merely passes on
  # is not linked to it.
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name} LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH "$ORIGIN")  # they lie side by side, wherever that is
  target_link_options(${target} PRIVATE LINKER:--as-needed LINKER:--exclude-libs,ALL)
  set_property(GLOBAL APPEND PROPERTY VANTAGE_LIBRARIES ${target})
endfunction()

# ---- vantage ------------------------------------------------------------------
# PROJ is loaded when it is needed, not linked, but with VANTAGE_LINK_PROJ: src/geo/proj_library.h.
set_source_files_properties(${source}/geo/proj_library.cpp PROPERTIES COMPILE_DEFINITIONS "${VANTAGE_PROJ_DEFINITIONS}")
# GDAL, OpenGL and libcurl are loaded when they are needed, where there is a loader.
option(VANTAGE_LOAD_LIBRARIES "Load libraries at run time; OFF for a program that is linked statically" ON)
if(NOT VANTAGE_LOAD_LIBRARIES)
  set_source_files_properties(${source}/core/system_limits.cpp PROPERTIES COMPILE_DEFINITIONS VANTAGE_LOADS_NO_LIBRARIES)
endif()
vantage_part(core
  MODULES core request options geo io tiles scene target query camera sensor prove simplify
  HOT exact
  OF_LIMITS prove ask leg
  SOURCES ${source}/core/threads_${VANTAGE_THREADS}.cpp ${source}/io/draco_${VANTAGE_DRACO}.cpp
          ${source}/io/meshopt_${VANTAGE_MESHOPT}.cpp
  LINK ${VANTAGE_THREAD_TARGETS} ZLIB::ZLIB ${VANTAGE_PROJ_TARGET} ${VANTAGE_CODEC_TARGETS} ${CMAKE_DL_LIBS}
  BUILD nlohmann_json::nlohmann_json vantage::cdt)
target_include_directories(vantage_core_objects SYSTEM PRIVATE ${VANTAGE_PROJ_INCLUDE_DIRS})
set(parts core)
if(VANTAGE_WITH_MISSIONS)
  if(VANTAGE_INSTALLED_MANIFOLD)
    vantage_part(solid MODULES solid arrangement OF_LIMITS cut LINK manifold::manifold ${VANTAGE_THREAD_TARGETS})
  else()
    vantage_part(solid MODULES solid arrangement OF_LIMITS cut LINK ${VANTAGE_THREAD_TARGETS} BUILD manifold::manifold)
  endif()
  set(more ${source}/app/kml_zones_none.cpp)
  set(kml_library)
  if(VANTAGE_WITH_VANTAGE)
    set(more ${source}/app/kml_zones_expat.cpp ${source}/app/verify_mission.cpp)
    set(kml_library EXPAT::EXPAT)
  endif()
  vantage_part(app MODULES app SOURCES ${more} LINK yaml-cpp ZLIB::ZLIB ${kml_library} BUILD nlohmann_json::nlohmann_json)
  list(APPEND parts solid app)
endif()
if(VANTAGE_WITH_VANTAGE)
  vantage_part(verify MODULES verify OF_LIMITS verify LINK embree)
  set(solver none)  # of linear programs
  set(solver_library)
  if(VANTAGE_HAS_HIGHS)
    set(solver highs)
    set(solver_library highs::highs)
  endif()
  vantage_part(flight
    MODULES flight SOURCES ${source}/flight/tour/linear_program_${solver}.cpp
    LINK EXPAT::EXPAT ZLIB::ZLIB BUILD nlohmann_json::nlohmann_json ${solver_library})
  list(APPEND parts verify flight)
endif()
vantage_library(vantage vantage PARTS ${parts})
if(NOT BUILD_SHARED_LIBS)  # they are not installed by themselves
  if(VANTAGE_WITH_MISSIONS AND NOT VANTAGE_INSTALLED_MANIFOLD)
    target_sources(vantage PRIVATE $<TARGET_OBJECTS:manifold>)
  endif()
  if(VANTAGE_HAS_HIGHS)
    target_sources(vantage PRIVATE $<TARGET_OBJECTS:vantage_highs>)
  endif()
endif()

# ---- what stands on it --------------------------------------------------------
if(VANTAGE_WITH_MAPS)
  vantage_part(maps
    MODULES maps
    LINK EXPAT::EXPAT BZip2::BZip2 ZLIB::ZLIB Threads::Threads PkgConfig::VANTAGE_CLIPPER ${CMAKE_DL_LIBS}
    BUILD vantage::osmium vantage::cdt nlohmann_json::nlohmann_json)
  vantage_library(vantage_maps maps PARTS maps REQUIRES vantage)
endif()
if(VANTAGE_WITH_PICTURE)
  vantage_part(depth MODULES depth spheres LINK embree ${CMAKE_DL_LIBS})
  vantage_part(picture MODULES picture LINK embree PkgConfig::VANTAGE_CAIRO)
  vantage_library(vantage_picture picture PARTS depth picture REQUIRES vantage)
endif()
get_property(VANTAGE_BUILT_LIBRARIES GLOBAL PROPERTY VANTAGE_LIBRARIES)

# All that is hidden, for tests and fuzz targets only.
get_property(parts GLOBAL PROPERTY VANTAGE_PARTS)
set(objects)
foreach(part IN LISTS parts)
  get_property(more GLOBAL PROPERTY VANTAGE_${part}_objects)
  list(APPEND objects ${more})
endforeach()
list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
add_library(vantage_inside STATIC EXCLUDE_FROM_ALL ${objects})
foreach(part IN LISTS parts)
  target_link_libraries(vantage_inside PUBLIC $<TARGET_PROPERTY:vantage_${part}_objects,LINK_LIBRARIES>)
endforeach()
target_include_directories(vantage_inside PUBLIC ${PROJECT_SOURCE_DIR}/include ${source})
