# Builds and runs a client against the installation in WORK_DIR/prefix, on a machine without the libraries of the
# engine. Called as cmake -DWORK_DIR=... -P client_only_test.cmake
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/client_only.cmake)

build_client_alone()
# No server listens at this port.
run(${program} 127.0.0.1:1)
if(NOT output STREQUAL "UNAVAILABLE\n")
  message(FATAL_ERROR "${program} printed ${output}")
endif()
