# HiGHS, linear programs for bounds of tours: the static library highs::highs, of the sources that scripts/fetch_sources.sh
# put into SOURCE_DIR. Not by the release's own CMakeLists.txt: that needs files which the release lacks (app/, highs.pc.in),
# changes the compiler's flags for whoever includes it, asks for processors with POPCNT, and loads a library at run time.
# Which sources there are is read from the release (cmake/sources.cmake).
enable_language(C)
# zig links the C library, and what goes with it, by itself. What CMake saw on its command while it tried this compiler
# would come before it: musl for a program with a fixed address, and zig's compiler-rt, whose sine would take the place of
# glibc's.
if(VANTAGE_ZIG)
  set(CMAKE_C_IMPLICIT_LINK_LIBRARIES)
endif()
include(CheckCXXSourceCompiles)

function(vantage_add_highs source_dir)
  if(NOT EXISTS ${source_dir}/cmake/sources.cmake)
    message(FATAL_ERROR "HiGHS is not in ${source_dir}: run scripts/fetch_sources.sh first, or set VANTAGE_WITH_HIGHS to OFF")
  endif()
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/third_party/highs)
  set(PROJECT_SOURCE_DIR ${source_dir})  # what the list of sources calls so
  set(HIGHS_BINARY_DIR ${generated})
  include(${source_dir}/cmake/sources.cmake)
  set(sources ${highs_sources} ${cupdlp_sources} ${ipx_sources} ${basiclu_sources} ${hipo_sources}
              ${factor_highs_sources} ${hipo_util_sources})
  list(TRANSFORM sources PREPEND ${source_dir}/highs/)
  # Of the "extras" only the empty shell: what is in them else is code of others, for a solver that is not used here.
  list(APPEND sources ${source_dir}/extern/HighsExtrasApi.cpp ${source_dir}/extern/HighsExtrasExternalDeps.cpp)

  file(STRINGS ${source_dir}/Version.txt version REGEX "^HIGHS_(MAJOR|MINOR|PATCH)=")
  foreach(line IN LISTS version)
    string(REGEX REPLACE "^HIGHS_([A-Z]+)=([0-9]+)$" "\\1;\\2" line "${line}")
    list(GET line 0 part)
    list(GET line 1 HIGHS_VERSION_${part})
  endforeach()
  set_source_files_properties(${source_dir}/extern/HighsExtrasApi.cpp PROPERTIES COMPILE_DEFINITIONS
    "HIGHS_EXTRAS_VERSION=\"${HIGHS_VERSION_MAJOR}.${HIGHS_VERSION_MINOR}.${HIGHS_VERSION_PATCH}\"")
  check_cxx_source_compiles("#include <immintrin.h>\nint main() { _mm_pause(); return 0; }" HIGHS_HAVE_MM_PAUSE)
  set(FAST_BUILD ON)
  set(CUPDLP_CPU ON)
  set(HIGHS_HAVE_BUILTIN_CLZ ON)
  set(GITHASH release)
  configure_file(${source_dir}/highs/HConfig.h.in ${generated}/HConfig.h)

  add_library(vantage_highs STATIC EXCLUDE_FROM_ALL ${sources})
  add_library(highs::highs ALIAS vantage_highs)
  target_include_directories(vantage_highs SYSTEM PRIVATE
    ${include_dirs} ${source_dir}/highs/ipm/hipo ${source_dir}/highs/ipm/hipo/auxiliary
    ${source_dir}/highs/ipm/hipo/factorhighs ${source_dir}/highs/ipm/hipo/ipm
    ${ZLIB_INCLUDE_DIRS})  # it tells zlib's version
  target_include_directories(vantage_highs SYSTEM INTERFACE ${generated} ${source_dir}/extern ${source_dir}/highs)
  target_compile_features(vantage_highs PRIVATE cxx_std_11)
  # No fused multiply-add, so that no answer depends on the compiler.
  target_compile_options(vantage_highs PRIVATE -w -ffp-contract=off)
  target_link_libraries(vantage_highs PRIVATE Threads::Threads)
  vantage_join_sources(vantage_highs 12)  # a third of the time to compile
  set_target_properties(vantage_highs PROPERTIES
    CXX_VISIBILITY_PRESET hidden C_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON POSITION_INDEPENDENT_CODE ON)
endfunction()
