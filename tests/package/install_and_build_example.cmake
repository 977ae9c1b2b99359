# Variables: BUILD_DIR, EXAMPLES_DIR, WORK_DIR, GENERATOR, CXX, CXX_FLAGS, PYTHON, CHECKER.

file(REMOVE_RECURSE "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")

execute_process(COMMAND ${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${prefix}"
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -S "${EXAMPLES_DIR}" -B "${WORK_DIR}/build" -G "${GENERATOR}"
                        "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
                        "-DCMAKE_PREFIX_PATH=${prefix};${EXAMPLES_DIR}/../build/debian/usr"
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build "${WORK_DIR}/build" --target example_trace_csv example_verbs
                COMMAND_ERROR_IS_FATAL ANY)
# The example's own numbers: the displaced zero that its readings were made with, within their 95 % interval.
execute_process(COMMAND "${PYTHON}" -B "${CHECKER}"
                        "${WORK_DIR}/build/example_trace_csv" "${EXAMPLES_DIR}/push.toml" --
                        "it lacks=displacement_offset" "reading.displacement_offset_mm=0.25+-0.053"
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${PYTHON}" -B "${CHECKER}" "${WORK_DIR}/build/example_verbs" "${EXAMPLES_DIR}/push.toml" --
                        "selected=[\"displacement_offset\"]"
                COMMAND_ERROR_IS_FATAL ANY)

# What was installed goes again, and nothing else.
file(WRITE "${prefix}/lib/of_another.txt" "stays")
execute_process(COMMAND ${CMAKE_COMMAND} "-DBUILD_DIR=${BUILD_DIR}" -P "${EXAMPLES_DIR}/../cmake/uninstall.cmake"
                COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE left LIST_DIRECTORIES true RELATIVE "${prefix}" "${prefix}/*")
list(FILTER left INCLUDE REGEX "snare|\\.")
if(NOT left STREQUAL "lib/of_another.txt")
  message(FATAL_ERROR "left behind, or taken too much: ${left}")
endif()
