# snare_use_precompiled_headers(<target>): the target's sources get cmake/precompiled.hpp, compiled once for all targets.
function(snare_use_precompiled_headers target)
  if(NOT TARGET snare_precompiled)
    add_library(snare_precompiled OBJECT "${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp")
    target_link_libraries(snare_precompiled PRIVATE Eigen3::Eigen fmt::fmt snare_build_settings)
    target_compile_features(snare_precompiled PRIVATE cxx_std_20)
    target_compile_definitions(snare_precompiled PRIVATE EIGEN_DONT_PARALLELIZE)
    target_precompile_headers(snare_precompiled PRIVATE "${PROJECT_SOURCE_DIR}/cmake/precompiled.hpp")
  endif()
  target_precompile_headers(${target} REUSE_FROM snare_precompiled)
endfunction()

# snare_add_module(<name> [PUBLIC <targets>...] [PRIVATE <targets>...] [EXCLUDE <files>...] [ALONE <files>...])
#
# Makes the target snare_<name> (alias snare::<name>) of the *.cpp beside the calling CMakeLists.txt. New
# files are found by the next build; a module that has no source yet is an INTERFACE library. ALONE: files with names of
# their own that others have too; they are not joined with others where a build joins sources (CMAKE_UNITY_BUILD).
function(snare_add_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "PUBLIC;PRIVATE;EXCLUDE;ALONE")

  set(target snare_${name})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  file(GLOB headers CONFIGURE_DEPENDS *.hpp)
  set_source_files_properties(${arg_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  foreach(file IN LISTS arg_EXCLUDE)
    list(REMOVE_ITEM sources "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
  endforeach()

  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE}
                                           $<BUILD_INTERFACE:snare_build_settings>)
    snare_use_precompiled_headers(${target})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_PUBLIC} ${arg_PRIVATE})
  endif()
  add_library(snare::${name} ALIAS ${target})

  target_compile_features(${target} ${scope} cxx_std_20)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_sources(${target} ${scope} FILE_SET HEADERS
                 BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${headers})
  # <snare/wire/mesh.hpp> in the build tree as where it is installed.
  file(RELATIVE_PATH room "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  string(REGEX REPLACE "/.*" "" room "${room}")
  file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/include/snare")
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${room}" "${PROJECT_BINARY_DIR}/include/snare/${room}" SYMBOLIC)
  target_include_directories(${target} ${scope} "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>"
                                                "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  install(TARGETS ${target} EXPORT snareTargets
          FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/snare")
endfunction()

# snare_add_module_group(<name> <modules>...): snare::<name> stands for all modules of a folder.
function(snare_add_module_group name)
  add_library(snare_${name} INTERFACE)
  add_library(snare::${name} ALIAS snare_${name})
  list(TRANSFORM ARGN PREPEND "snare::" OUTPUT_VARIABLE modules)
  target_link_libraries(snare_${name} INTERFACE ${modules})
  set_target_properties(snare_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS snare_${name} EXPORT snareTargets)
endfunction()
