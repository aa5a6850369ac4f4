# Compiler options of our own code; third-party code is built with its own.
add_library(vantage_options INTERFACE)
add_library(vantage::options ALIAS vantage_options)
# -ffp-contract=off: a fused multiply-add rounds differently from one compiler to the next, and the exact predicates of
# the triangulation rely on plain IEEE arithmetic.
# -fno-semantic-interposition: lets the shared library inline its own functions.
target_compile_options(vantage_options INTERFACE -Wall -Wextra -ffp-contract=off -fno-semantic-interposition
                       $<$<CXX_COMPILER_ID:Clang>:-Wcomma>)
# Eigen's vector instructions add in another order, so that the last digits would depend on the processor. Its alignment
# stays that of code that uses them: the two may be linked.
target_compile_definitions(vantage_options INTERFACE EIGEN_DONT_VECTORIZE EIGEN_MAX_ALIGN_BYTES=16
                                                     EIGEN_MAX_STATIC_ALIGN_BYTES=16)
if(NOT (VANTAGE_JOIN_SOURCES AND CMAKE_CXX_COMPILER_ID MATCHES "Clang"))
  target_compile_options(vantage_options INTERFACE -Wshadow)  # for clang names of one source shadow those of others
endif()
if(VANTAGE_WERROR AND VANTAGE_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Neither -Werror nor silence: GCC's manual says that sanitizers make warnings find what is not there (in <regex>, in
  # the standard library's strings). The build without sanitizers has the same files and judges them.
elseif(VANTAGE_WERROR)
  target_compile_options(vantage_options INTERFACE -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 warns of overflows in the standard library's strings that cannot happen.
    target_compile_options(vantage_options INTERFACE -Wno-error=stringop-overflow -Wno-error=restrict)
  endif()
endif()

if(VANTAGE_SANITIZE)
  # Everything, third-party code too: a sanitizer that sees half of a program reports false races.
  add_compile_options(-fsanitize=${VANTAGE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${VANTAGE_SANITIZE})
endif()
# ---- hardening: what makes a mistake end the program instead of letting an input take it over. Of all that is compiled,
# third-party sources too. tests/check_binaries.py reads it from the binaries; docs/libraries.md says what is on, and where
# what it costs is written.
set(hardened_by_default OFF)
if(PROJECT_IS_TOP_LEVEL AND NOT EMSCRIPTEN)
  set(hardened_by_default ON)
endif()
option(VANTAGE_HARDEN "Harden what is built: stack protector, FORTIFY, CET, RELRO (not where a sanitizer looks)"
       ${hardened_by_default})
option(VANTAGE_HARDEN_ENGINE "Leave the standard library's checks (_GLIBCXX_ASSERTIONS) on in the engine too" OFF)
# AddressSanitizer sees less where FORTIFY puts its own checks before.
if(VANTAGE_HARDEN AND NOT VANTAGE_SANITIZE AND NOT EMSCRIPTEN)
  include(CheckCXXCompilerFlag)
  include(CheckLinkerFlag)
  include(CheckPIESupported)
  check_pie_supported(OUTPUT_VARIABLE no_pie LANGUAGES CXX)  # programs may lie anywhere in memory
  if(NOT CMAKE_CXX_LINK_PIE_SUPPORTED)
    message(WARNING "VANTAGE_HARDEN: programs are linked to a fixed address: ${no_pie}")
  endif()
  foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection)
    string(MAKE_C_IDENTIFIER "VANTAGE_HAS${flag}" has)
    check_cxx_compiler_flag(${flag} ${has})
    if(${has})
      add_compile_options(${flag})
    endif()
  endforeach()
  # Bounds of what the standard library and the C library are asked to read and write. FORTIFY needs the optimizer; level 3
  # is understood by GCC 12 and clang 9, and is a warning before.
  set(level 2)
  if((CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12) OR
     (CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 9))
    set(level 3)
  endif()
  add_compile_options("$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=${level}>" -D_GLIBCXX_ASSERTIONS)
  # But for the engine, where each of them is in an inner loop. Its inputs are checked before it. What both it and other
  # sources of the library call without inlining it is one function after linking: the checked one where that comes first
  # on the linker's line, as in the shared library. So others may lose such a check in a static library, and the engine
  # may keep one.
  if(NOT VANTAGE_HARDEN_ENGINE)
    set(VANTAGE_HOT_OPTIONS -U_GLIBCXX_ASSERTIONS)
  endif()
  # All addresses of functions are settled at the start, and cannot be changed after.
  foreach(flag relro now noexecstack)
    check_linker_flag(CXX "LINKER:-z,${flag}" VANTAGE_LINKS_${flag})
    if(VANTAGE_LINKS_${flag})
      add_link_options("LINKER:-z,${flag}")
    endif()
  endforeach()
endif()

# vantage_join_sources(TARGET [COUNT]): so many sources to a compilation. A first build takes less time, a build after each
# change more. Names in their anonymous namespaces must differ then. Not for fuzz targets, which stand alone.
function(vantage_join_sources target)
  if(VANTAGE_JOIN_SOURCES)
    set(count 20)
    if(ARGC GREATER 1)
      set(count ${ARGV1})
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${count})
    # GCC takes a source for a header that others include too.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

if(VANTAGE_FUZZ_COVERAGE)
  add_compile_options(-fsanitize=fuzzer-no-link)  # for the fuzzer to be guided by
endif()

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(VANTAGE_CCACHE ccache)
  if(VANTAGE_CCACHE)
    # Paths below the project count as relative, so that a clone elsewhere finds what this one compiled. Headers are not
    # precompiled: ccache would hand a header precompiled from one clone to another, where GCC does not know it again by
    # its path, so that `#pragma once` fails.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
                                    ${VANTAGE_CCACHE})
    set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
  endif()
endif()
