# Builds for other systems than this one with the clang, the C++ library and the glibc stubs of zig (scripts/zig_compiler.sh
# makes the commands). VANTAGE_ZIG: the folder of these commands. VANTAGE_ZIG_PREFIX: where the libraries lie that
# scripts/build_wheel_libraries.py built for the same system; nothing else is looked into.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VANTAGE_ZIG VANTAGE_ZIG_PREFIX VANTAGE_ZIG_PROCESSOR
     VANTAGE_ZIG_SYSTEM)
set(CMAKE_SYSTEM_NAME Linux)
if(VANTAGE_ZIG_SYSTEM)  # Windows, Darwin
  set(CMAKE_SYSTEM_NAME ${VANTAGE_ZIG_SYSTEM})
endif()
set(CMAKE_SYSTEM_PROCESSOR ${VANTAGE_ZIG_PROCESSOR})
set(CMAKE_C_COMPILER ${VANTAGE_ZIG}/clang)
set(CMAKE_CXX_COMPILER ${VANTAGE_ZIG}/clang++)
foreach(language C CXX)
  set(CMAKE_${language}_COMPILER_AR ${VANTAGE_ZIG}/ar)
  set(CMAKE_${language}_COMPILER_RANLIB ${VANTAGE_ZIG}/ranlib)
endforeach()
set(CMAKE_AR ${VANTAGE_ZIG}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${VANTAGE_ZIG}/ranlib CACHE FILEPATH "")
set(CMAKE_FIND_ROOT_PATH ${VANTAGE_ZIG_PREFIX})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
foreach(language C CXX)
  set(CMAKE_${language}_STANDARD_LIBRARIES ${VANTAGE_ZIG}/libvantage_zig.a)  # zig_runtime.c, zig_hypot.c
endforeach()
set(CMAKE_TRY_COMPILE_CONFIGURATION Release)  # zig builds its C++ library once for each kind
