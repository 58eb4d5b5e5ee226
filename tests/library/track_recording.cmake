# Installs the library from BUILD, builds SOURCE against it and tracks a simulated recording, all below SCRATCH.
file(REMOVE_RECURSE ${SCRATCH})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}: exit ${code}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --component library --prefix ${SCRATCH}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/build -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${SCRATCH}/prefix
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=-Wall)
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${HULLTRACK} simulate --scenario static --frames 25 --out ${SCRATCH}/recording)
run(${SCRATCH}/build/track_recording ${SCRATCH}/recording)
string(REGEX MATCHALL "frame [0-9]+: health 1" healthy "${output}")
list(LENGTH healthy healthy)
message("${output}")
if(healthy LESS 10)
  message(FATAL_ERROR "${healthy} frames of 25 are healthy")
endif()
