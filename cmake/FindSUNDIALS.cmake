# FindSUNDIALS: the libraries of SUNDIALS that are named as components. Defines a target SUNDIALS::<component> for each.
#
# Static libraries are preferred: they depend on nothing, while Debian's shared ones depend on PETSc, and the command opens
# fewer libraries when it starts.
include(FindPackageHandleStandardArgs)

find_path(SUNDIALS_INCLUDE_DIR sundials/sundials_config.h)
mark_as_advanced(SUNDIALS_INCLUDE_DIR)
set(SUNDIALS_VERSION "")
if(SUNDIALS_INCLUDE_DIR)
  file(STRINGS "${SUNDIALS_INCLUDE_DIR}/sundials/sundials_config.h" _line REGEX "define SUNDIALS_VERSION \"")
  string(REGEX REPLACE ".*\"(.*)\".*" "\\1" SUNDIALS_VERSION "${_line}")
endif()
foreach(_component IN LISTS SUNDIALS_FIND_COMPONENTS)
  find_library(SUNDIALS_${_component}_LIBRARY NAMES libsundials_${_component}.a sundials_${_component})
  mark_as_advanced(SUNDIALS_${_component}_LIBRARY)
  if(SUNDIALS_${_component}_LIBRARY)
    set(SUNDIALS_${_component}_FOUND TRUE)
  endif()
endforeach()

find_package_handle_standard_args(SUNDIALS REQUIRED_VARS SUNDIALS_INCLUDE_DIR VERSION_VAR SUNDIALS_VERSION HANDLE_COMPONENTS)
if(SUNDIALS_FOUND)
  foreach(_component IN LISTS SUNDIALS_FIND_COMPONENTS)
    if(NOT TARGET SUNDIALS::${_component})
      add_library(SUNDIALS::${_component} UNKNOWN IMPORTED)
      set_target_properties(SUNDIALS::${_component} PROPERTIES
        IMPORTED_LOCATION "${SUNDIALS_${_component}_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${SUNDIALS_INCLUDE_DIR}"
        INTERFACE_LINK_LIBRARIES "$<$<STREQUAL:${_component},sunlinsolklu>:SuiteSparse::KLU>")
    endif()
  endforeach()
endif()
