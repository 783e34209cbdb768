# Builds and installs the core alone, without the service and the optional component, then builds and runs the project
# beside this file against it. None of the libraries left out may be found or included in any of the steps.
# Called as cmake -DSOURCE_DIR=... -DWORK_DIR=... -DCORE_DIR=... -DCXX_FLAGS=... -DLAUNCHER=... -P core_only_test.cmake
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE ${WORK_DIR} ${CORE_DIR})
foreach(header arb.h flint/flint.h gmp.h grpcpp/grpcpp.h google/protobuf/message.h)
  file(WRITE ${WORK_DIR}/poison/${header} "#error \"the core alone does not have this library\"\n")
endforeach()
string(APPEND CXX_FLAGS " -I${WORK_DIR}/poison")
foreach(package CLI11 FLINT GTest Protobuf gRPC spdlog)
  list(APPEND nothing_else -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()

run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${CORE_DIR} -G Ninja ${nothing_else}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
    -DRICOCHET_SERVICE=OFF -DRICOCHET_CERTIFIED=OFF
    -DRICOCHET_TESTS=OFF -DRICOCHET_BENCHMARKS=OFF)
run(${CMAKE_COMMAND} --build ${CORE_DIR})
run(${CMAKE_COMMAND} --install ${CORE_DIR} --prefix ${WORK_DIR}/prefix)
build_consumer(${nothing_else} -DCOMPONENTS=core)
expect_answer(${WORK_DIR}/build/consumer)

# A component that is not there is refused by name.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/refused -G Ninja
                        -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCOMPONENTS=certified
                OUTPUT_QUIET ERROR_VARIABLE output RESULT_VARIABLE result)
if(result EQUAL 0 OR NOT output MATCHES "no component certified")
  message(FATAL_ERROR "COMPONENTS certified was not refused by name: ${output}")
endif()
file(REMOVE_RECURSE ${WORK_DIR} ${CORE_DIR})
