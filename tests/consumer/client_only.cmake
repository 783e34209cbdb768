# Builds the client of the project beside this file, and nothing else of it, against the installation in
# WORK_DIR/prefix. Neither CMake nor the compiler may find a library that the engine alone needs, and the program must
# link none. Included after run.cmake by scripts that set WORK_DIR, CXX_FLAGS and LAUNCHER.

# Builds the program, and puts its path into `program` in the caller.
function(build_client_alone)
  foreach(header arb.h flint/flint.h gmp.h cvode/cvode.h hwy/highway.h sleef.h Eigen/Core)
    file(WRITE ${WORK_DIR}/poison/${header} "#error \"a client does not have this library\"\n")
  endforeach()
  foreach(package Eigen3 FLINT SUNDIALS hwy sleef)
    list(APPEND nothing_else -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
  endforeach()
  string(APPEND CXX_FLAGS " -I${WORK_DIR}/poison")
  build_consumer(${nothing_else} -DCOMPONENTS=client)
  set(program ${WORK_DIR}/build/client_consumer PARENT_SCOPE)
  expect_no_engine(${WORK_DIR}/build/client_consumer)
endfunction()

# Stops if the program needs one of those libraries, or has functions of one or of the engine in itself.
function(expect_no_engine program)
  run(ldd ${program})
  if(output MATCHES "lib(flint|arb|gmp|sundials|hwy|sleef)[^\n]*")
    message(FATAL_ERROR "${program} needs ${CMAKE_MATCH_0}")
  endif()
  run(nm --demangle ${program})
  if(output MATCHES "[^\n]* (arb_|fmpz_|CVode|Sleef_|hwy::|Eigen::|ricochet::LocalSolver::|ricochet::planar::)[^\n]*")
    message(FATAL_ERROR "${program} has ${CMAKE_MATCH_0}")
  endif()
endfunction()
