# cmake -DMODE=find_package|add_subdirectory -DVANTAGE_SOURCE_DIR=... -DVANTAGE_BUILD_DIR=... -P run.cmake
# Builds and runs the consumer project in a scratch folder below the build folder.
cmake_minimum_required(VERSION 3.25)
set(scratch ${VANTAGE_BUILD_DIR}/consumer/${MODE})
file(REMOVE_RECURSE ${scratch})

function(run)
  list(JOIN ARGN " " line)
  message(STATUS "${line}")
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "failed (${failed}): ${line}")
  endif()
endfunction()

if(MODE STREQUAL "find_package")
  # Moved after the installation: an installed tree may not know where it lies.
  run(${CMAKE_COMMAND} --install ${VANTAGE_BUILD_DIR} --prefix ${scratch}/staging)
  file(RENAME ${scratch}/staging ${scratch}/prefix)
  foreach(text LICENSE THIRD-PARTY-NOTICES.txt LICENSE.CDT LICENSE.CDT-predicates LICENSE.CDT-LLVM)
    if(NOT EXISTS ${scratch}/prefix/share/doc/vantage/${text})
      message(FATAL_ERROR "${text} is not installed")
    endif()
  endforeach()
  set(how -DCMAKE_PREFIX_PATH=${scratch}/prefix)
elseif(MODE STREQUAL "add_subdirectory")
  set(how -DUSE_SUBDIRECTORY=${VANTAGE_SOURCE_DIR} -DCMAKE_PREFIX_PATH=${PREFIX_PATH})
  # All of vantage is compiled for it once more: without the optimizer, which takes half of the time.
  set(BUILD_TYPE Debug)
  list(APPEND how -DCMAKE_CXX_FLAGS_DEBUG=-O0)
else()
  message(FATAL_ERROR "MODE is find_package or add_subdirectory, not '${MODE}'")
endif()

file(GLOB headers RELATIVE ${VANTAGE_SOURCE_DIR}/include/vantage ${VANTAGE_SOURCE_DIR}/include/vantage/*.h)
list(JOIN headers "," headers)
run(${CMAKE_COMMAND} -S ${VANTAGE_SOURCE_DIR}/tests/consumer -B ${scratch}/build -G Ninja
    -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DHEADERS=${headers} ${how})
run(${CMAKE_COMMAND} --build ${scratch}/build --target consumer --parallel 2)
run(${scratch}/build/consumer ${VANTAGE_SOURCE_DIR}/examples/plaza/mission.yaml ${scratch}/volume.ply)
if(EXISTS ${scratch}/prefix/bin/vantage)
  run(${CMAKE_COMMAND} -E env --unset=LD_LIBRARY_PATH ${scratch}/prefix/bin/vantage --version)
endif()
file(REMOVE_RECURSE ${scratch})
