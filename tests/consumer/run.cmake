# Commands that must succeed, for the scripts beside this file.

# Runs a command and stops unless it succeeds. Sets `output` in the caller.
function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${result}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# Runs a program and stops unless it prints exactly `text`.
function(expect_output program text)
  run(${program})
  if(NOT output STREQUAL text)
    message(FATAL_ERROR "${program} printed\n${output}instead of\n${text}")
  endif()
endfunction()

# Configures and builds the project beside this file against the installation in WORK_DIR/prefix; the arguments are
# options of CMake.
function(build_consumer)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_FUNCTION_LIST_DIR} -B ${WORK_DIR}/build -G Ninja
      -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
      ${ARGN})
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
endfunction()

# Stops unless the program of main.cc prints what its scene gives.
function(expect_answer program)
  expect_output(${program} "0.976188 -0.464299 -0.071436\n0.011906 -0.76785 -3.14284\n")
endfunction()
