# snare_use_precompiled_headers(<target> <header>): the target's sources get cmake/<header>.hpp, compiled once for all targets.
# GCC takes the optimisation level from a precompiled header, so that targets of another level need another header.
function(snare_use_precompiled_headers target header)
  if(NOT TARGET snare_${header})
    add_library(snare_${header} OBJECT "${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp")
    target_link_libraries(snare_${header} PRIVATE Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json snare_build_settings)
    target_compile_features(snare_${header} PRIVATE cxx_std_20)
    target_compile_definitions(snare_${header} PRIVATE EIGEN_DONT_PARALLELIZE)
    target_precompile_headers(snare_${header} PRIVATE "${PROJECT_SOURCE_DIR}/cmake/${header}.hpp")
    if(header STREQUAL "precompiled_light")
      target_compile_options(snare_${header} PRIVATE ${SNARE_LIGHT_OPTIONS})
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM snare_${header})
endfunction()

# Optimisation of a LIGHT module in an optimised build; other builds make no difference.
set(SNARE_LIGHT_OPTIONS "")
if(CMAKE_BUILD_TYPE MATCHES "^Rel")
  set(SNARE_LIGHT_OPTIONS -O1)
endif()

# How the sources of a module are compiled: the part of snare_add_module that its two targets share.
function(snare_compile_module target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}")
  # <snare/wire/mesh.hpp> in the build tree as where it is installed.
  target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>"
                                              "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  # Joined sources of equal size, at most 16 each.
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  foreach(file IN LISTS arg_ALONE)
    list(REMOVE_ITEM sources "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
  endforeach()
  list(LENGTH sources count)
  if(count GREATER 0)
    math(EXPR batches "(${count} + 15) / 16")
    math(EXPR batch "(${count} + ${batches} - 1) / ${batches}")
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
  if(arg_LIGHT AND SNARE_LIGHT_OPTIONS)
    target_compile_options(${target} PRIVATE ${SNARE_LIGHT_OPTIONS})
    snare_use_precompiled_headers(${target} precompiled_light)
  else()
    snare_use_precompiled_headers(${target} precompiled)
  endif()
endfunction()

# snare_add_module(<name> [LIGHT] [ROOMS <folders>...] [PUBLIC <targets>...] [PRIVATE <targets>...] [EXCLUDE <files>...]
#                  [ALONE <files>...] [FIRST <files>...|ALL] [DEFINITIONS <definitions>...])
#
# Makes the target snare_<name> (alias snare::<name>) of the *.cpp in the folder of the calling CMakeLists.txt and in ROOMS
# below it. New files are found by the next build; a module that has no source yet is an INTERFACE library.
# LIGHT: the module reads and writes; no computation spends its time there, so that it is optimised less.
# ALONE: files with names of their own that others have too; they are not joined with others where a build joins sources
# (CMAKE_UNITY_BUILD).
# FIRST: files that the main job needs (snare_first in app/CMakeLists.txt); their target is snare_<name>_first.
function(snare_add_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LIGHT" "" "ROOMS;PUBLIC;PRIVATE;EXCLUDE;ALONE;FIRST;DEFINITIONS")

  set(target snare_${name})
  list(TRANSFORM arg_ROOMS APPEND "/*.cpp" OUTPUT_VARIABLE sources_of_rooms)
  list(TRANSFORM arg_ROOMS APPEND "/*.hpp" OUTPUT_VARIABLE headers_of_rooms)
  file(GLOB sources CONFIGURE_DEPENDS *.cpp ${sources_of_rooms})
  file(GLOB headers CONFIGURE_DEPENDS *.hpp ${headers_of_rooms})
  set_source_files_properties(${arg_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  foreach(file IN LISTS arg_EXCLUDE)
    list(REMOVE_ITEM sources "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
  endforeach()

  if(sources)
    set(first ${sources})
    if(NOT arg_FIRST STREQUAL "ALL")
      list(TRANSFORM arg_FIRST PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE first)
    endif()
    set(objects "")
    if(first)
      list(REMOVE_ITEM sources ${first})
      add_library(${target}_first OBJECT ${first})
      target_link_libraries(${target}_first PRIVATE ${arg_PUBLIC} ${arg_PRIVATE} snare_build_settings)
      target_compile_definitions(${target}_first PRIVATE ${arg_DEFINITIONS})
      snare_compile_module(${target}_first)
      set_property(GLOBAL APPEND PROPERTY SNARE_FIRST_OBJECTS $<TARGET_OBJECTS:${target}_first>)
      set(objects $<TARGET_OBJECTS:${target}_first>)
    endif()
    add_library(${target} STATIC ${sources} ${objects})
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)
    set(scope PUBLIC)
    target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE}
                                           $<BUILD_INTERFACE:snare_build_settings>)
    target_compile_definitions(${target} PRIVATE ${arg_DEFINITIONS})
    snare_compile_module(${target})
    if(NOT arg_LIGHT)
      set_property(GLOBAL APPEND PROPERTY SNARE_OPTIMISED_MODULES ${target})
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_PUBLIC} ${arg_PRIVATE})
  endif()
  add_library(snare::${name} ALIAS ${target})

  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_sources(${target} ${scope} FILE_SET HEADERS
                 BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${headers})
  file(RELATIVE_PATH room "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  string(REGEX REPLACE "/.*" "" room "${room}")
  file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/include/snare")
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${room}" "${PROJECT_BINARY_DIR}/include/snare/${room}" SYMBOLIC)
  install(TARGETS ${target} EXPORT snareTargets
          FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/snare")
endfunction()

# snare_link_optimised_first(<target>): a program or shared library that links modules takes inline functions, of which every object
# that uses them has a copy, from the optimised modules: the linker keeps the first copy.
function(snare_link_optimised_first target)
  get_property(modules GLOBAL PROPERTY SNARE_OPTIMISED_MODULES)
  list(TRANSFORM modules REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  list(JOIN modules "," archives)
  target_link_options(${target} PRIVATE "LINKER:--whole-archive,${archives},--no-whole-archive")
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
