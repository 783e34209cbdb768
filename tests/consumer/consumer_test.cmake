# Installs the build into a fresh prefix, then configures, builds and runs the project beside this file against it, and
# builds its program a second time by the line that pkg-config gives.
# Called as cmake -DBUILD_DIR=... -DWORK_DIR=... -DCXX_FLAGS=... -DLAUNCHER=... -DCXX=... -DLIBDIR=...
# -P consumer_test.cmake
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/client_only.cmake)

# Compiles one source by the flags of the pkg-config packages in ARGN.
function(build_by_pkg_config source program)
  run(${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${WORK_DIR}/prefix/${LIBDIR}/pkgconfig
      pkg-config --cflags --libs ${ARGN})
  separate_arguments(flags UNIX_COMMAND "${CXX_FLAGS} -std=c++20 ${CMAKE_CURRENT_LIST_DIR}/${source} ${output}")
  run(${CXX} -o ${program} ${flags})
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
build_consumer()
expect_answer(${WORK_DIR}/build/consumer)
run(${WORK_DIR}/build/eigen_consumer)
expect_output(${WORK_DIR}/build/native_eigen_consumer "${output}")
build_by_pkg_config(main.cc ${WORK_DIR}/build/plain_consumer ricochet-core)
expect_answer(${WORK_DIR}/build/plain_consumer)

if(EXISTS ${WORK_DIR}/build/remote_consumer)
  set(swept "1\n0.707107\n0.447214\n0\n")
  expect_output(${WORK_DIR}/build/remote_consumer ${swept})
  build_by_pkg_config(remote.cc ${WORK_DIR}/build/plain_remote_consumer ricochet-client ricochet-core)
  expect_output(${WORK_DIR}/build/plain_remote_consumer ${swept})

  # A client alone, by CMake and by pkg-config, asks the installed server.
  build_client_alone()
  build_by_pkg_config(client.cc ${WORK_DIR}/build/plain_client_consumer ricochet-client)
  expect_no_engine(${WORK_DIR}/build/plain_client_consumer)
  foreach(client ${program} ${WORK_DIR}/build/plain_client_consumer)
    run(bash ${CMAKE_CURRENT_LIST_DIR}/with_server.sh ${WORK_DIR}/prefix/bin/ricochetd ${WORK_DIR} ${client})
    if(NOT output STREQUAL "0.707107\n")
      message(FATAL_ERROR "${client} printed ${output}")
    endif()
  endforeach()
endif()
foreach(file include/ricochet/solver.h share/ricochet/proto/ricochet/v1/impact_service.proto
        share/ricochet/examples/dropped_rod.textproto)
  if(NOT EXISTS ${WORK_DIR}/prefix/${file})
    message(FATAL_ERROR "not installed: ${file}")
  endif()
endforeach()
file(REMOVE_RECURSE ${WORK_DIR})
