# Language, warnings, sanitizers, compiler cache. Nothing here may change a result from one machine to the
# next: no -march=native, no -ffast-math.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(SNARE_CCACHE ccache)
mark_as_advanced(SNARE_CCACHE)
if(SNARE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # The settings that precompiled headers ask for; paths below the repository count as relative, so that clones share.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND}" -E env "CCACHE_SLOPPINESS=pch_defines,time_macros" "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}"
      CCACHE_NOHASHDIR=1 "${SNARE_CCACHE}")
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
                      "$<$<COMPILE_LANG_AND_ID:CXX,Clang>:SHELL:-Xclang -fno-pch-timestamp>")
endif()

# Precompiled headers fill GCC's heap from the start, and it would look for garbage in them again and again: a tenth of the
# time to compile. Without that it takes a quarter more memory, some 1.1 GB for the largest sources.
add_compile_options("$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=800000>")

# The Python module is a shared library of the static ones. Nobody replaces one of their functions when it is loaded, so that
# they may be inlined as in a program.
if(SNARE_BUILD_PYTHON)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  add_compile_options(-fno-semantic-interposition)
endif()

# Private settings of our own targets; never exported.
add_library(snare_build_settings INTERFACE)
target_compile_options(snare_build_settings INTERFACE -Wall -Wextra -Wpedantic -Wshadow)
# GCC 12 warns falsely about strings that are joined (its bug 105651).
target_compile_options(snare_build_settings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(CMAKE_UNITY_BUILD)
  # A joined source counts as a header: what is private to it would be seen by others. And a local name is not hidden by a
  # function of the next source, of which the two know nothing.
  # GCC 12 also warns falsely about strings and matrices of the standard library and Eigen once more of them is inlined.
  target_compile_options(snare_build_settings INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage;-Wno-shadow;-Wno-stringop-overflow;-Wno-maybe-uninitialized>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-free-nonheap-object>
    $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>)
endif()

# Sanitized code and the tests that use it must agree, so the flags hold for the whole tree.
set(SNARE_SANITIZER_FLAGS "")
if(SNARE_SANITIZE)
  # Null pointers, wrong sizes and pointers that wrap round end in the address sanitizer as well; looking for them twice, and
  # for alignment, which x86 does not ask for, takes two fifths of the time to compile, and pointers an eighth of that to run.
  set(SNARE_SANITIZER_FLAGS -fsanitize=address,undefined -fno-sanitize=null,alignment,object-size,pointer-overflow
      -fno-sanitize-recover=all)
  add_compile_options(${SNARE_SANITIZER_FLAGS} -fno-omit-frame-pointer)
  add_link_options(${SNARE_SANITIZER_FLAGS})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  # Under the address sanitizer Eigen would align by itself what malloc aligns already, and could not free what a library
  # of the system, built without it, returns.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC warns falsely about Eigen's expressions once they are instrumented.
    target_compile_options(snare_build_settings INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
