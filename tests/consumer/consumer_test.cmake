# Installs the build into a fresh prefix, then configures, builds and runs the project beside this file against it.
# Called as cmake -DBUILD_DIR=... -DWORK_DIR=... -P consumer_test.cmake

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${result}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_output program text)
  run(${program})
  if(NOT output STREQUAL text)
    message(FATAL_ERROR "${program} printed\n${output}instead of\n${text}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/build -G Ninja
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)

expect_output(${WORK_DIR}/build/consumer "Newton 0.707107, Poisson 1.41421\n")
if(EXISTS ${WORK_DIR}/build/remote_consumer)
  expect_output(${WORK_DIR}/build/remote_consumer "1\n0.707107\n0.447214\n0\n")
endif()
file(REMOVE_RECURSE ${WORK_DIR})
