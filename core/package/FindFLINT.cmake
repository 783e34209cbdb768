# Finds FLINT and defines FLINT::flint. Arb is inside FLINT 3; before, it was a library of its own, arb or, in Debian,
# flint-arb. Both call GMP from inline functions. Installed beside ricochetConfig.cmake, which asks for it as well.
find_path(FLINT_INCLUDE_DIR flint/flint.h)
find_library(FLINT_LIBRARY flint)
find_library(FLINT_GMP_LIBRARY gmp)
set(flint_required FLINT_LIBRARY FLINT_GMP_LIBRARY FLINT_INCLUDE_DIR)
set(flint_libraries ${FLINT_LIBRARY} ${FLINT_GMP_LIBRARY})
if(NOT EXISTS "${FLINT_INCLUDE_DIR}/flint/arb.h")
  find_path(FLINT_ARB_INCLUDE_DIR arb.h)
  find_library(FLINT_ARB_LIBRARY NAMES flint-arb arb)
  list(APPEND flint_required FLINT_ARB_LIBRARY FLINT_ARB_INCLUDE_DIR)
  list(PREPEND flint_libraries ${FLINT_ARB_LIBRARY})
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(FLINT REQUIRED_VARS ${flint_required})
mark_as_advanced(FLINT_INCLUDE_DIR FLINT_LIBRARY FLINT_GMP_LIBRARY FLINT_ARB_INCLUDE_DIR FLINT_ARB_LIBRARY)

if(FLINT_FOUND AND NOT TARGET FLINT::flint)
  add_library(FLINT::flint INTERFACE IMPORTED)
  set_target_properties(FLINT::flint PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${FLINT_INCLUDE_DIR};${FLINT_ARB_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${flint_libraries}")
endif()
