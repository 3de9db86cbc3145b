# One helper sets standard, warnings and sanitizers for every library, so that no target can drift.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endif()

function(lacerta_configure_target target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # -ffp-contract=off: the same floats from every compiler (docs/format.md, "Numbers").
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Werror -ffp-contract=off)
  if(LACERTA_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${LACERTA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${LACERTA_SANITIZE})
  endif()
  if(LACERTA_SANITIZE STREQUAL "thread")  # in place of the packaged TBB, which is not instrumented
    target_include_directories(${target} BEFORE PRIVATE ${PROJECT_SOURCE_DIR}/tests/tsan)
  endif()
  if(LACERTA_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# lacerta_add_library(lacerta_decoder SOURCES ...) makes the library and its alias lacerta::decoder.
function(lacerta_add_library target)
  cmake_parse_arguments(ARG "" "" "SOURCES" ${ARGN})
  add_library(${target} STATIC ${ARG_SOURCES})
  string(REPLACE "lacerta_" "" short_name ${target})
  add_library(lacerta::${short_name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${short_name})
  lacerta_configure_target(${target})
  install(TARGETS ${target} EXPORT LacertaTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()
