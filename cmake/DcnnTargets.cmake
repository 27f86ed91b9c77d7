# What makes a fault of memory hard to use (SECURITY.md): positions drawn at random, tables of addresses read-only once
# they are bound, canaries and probes of the stack, checked string functions, marked targets of jumps.
# tests/cli/hardened_test.cpp reads it from the programs.
function(dcnn_harden target)
  if(NOT DCNN_HARDENED OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    return()
  endif()
  get_target_property(type ${target} TYPE)
  target_compile_options(${target} PRIVATE -fstack-protector-strong -fstack-clash-protection)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
    set(fortify 3)
  else()
    set(fortify 2)
  endif()
  target_compile_options(${target} PRIVATE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=${fortify})
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(${target} PRIVATE -fcf-protection=full)
  endif()
  get_target_property(shared_code ${target} POSITION_INDEPENDENT_CODE)
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang AND NOT shared_code)
    target_compile_options(${target} PRIVATE -fPIE)  # GCC of Debian does so by itself
  endif()
  if(type STREQUAL EXECUTABLE)
    target_link_options(${target} PRIVATE -pie)
  endif()
  if(NOT type STREQUAL STATIC_LIBRARY)
    target_link_options(${target} PRIVATE LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)
  endif()
endfunction()

# How every target of this project is compiled.
function(dcnn_flags target)
  dcnn_harden(${target})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Templates fill the compiler's memory: collecting it every few megabytes takes a twentieth of its time.
    target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=700000)
  endif()
  if(NOT DCNN_WARNINGS)
    return()
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # GCC 12 reports the inlined code of std::string itself (GCC bugs 105329 and 105651), and memory that
    # Eigen has resized (bug 104475).
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow -Wno-restrict
      -Wno-use-after-free)
  endif()
  if(DCNN_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# The same, and the headers that take longest precompiled, or those of the target FROM, whose code must be of the same kind:
# position-independent (dcnn), or that of programs (dcnn_program_headers).
function(dcnn_compile_options target)
  cmake_parse_arguments(PARSE_ARGV 1 headers "" FROM "")
  dcnn_flags(${target})
  if(headers_FROM)
    target_precompile_headers(${target} REUSE_FROM ${headers_FROM})
  else()
    target_precompile_headers(${target} PRIVATE
      <Eigen/Dense> <dcnn/core/json.h> <algorithm> <functional> <memory> <sstream> <string> <vector>)
  endif()
endfunction()

# Some eight files of a module are compiled as one, which halves the time of a full build, that of the tests as that of the
# library. Any grouping compiles (tools/check-rooms); a file's group follows from its name alone, so that a new file moves no
# other. Highway's kernels include themselves: they stay apart.
function(dcnn_unite_rooms target root)  # ROOT: the folder of the modules' folders
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  list(TRANSFORM sources REPLACE "^${root}/" "")
  list(FILTER sources INCLUDE REGEX "/")
  list(FILTER sources EXCLUDE REGEX "^nn/kernels/")
  foreach(source ${sources})
    string(REGEX MATCH "^[^/]+" room ${source})
    set(in_room ${sources})
    list(FILTER in_room INCLUDE REGEX "^${room}/")
    list(LENGTH in_room count)
    set(groups 1)
    while(count GREATER DCNN_MOST_UNITED)  # groups: the power of two that leaves half as many to so many files in each
      math(EXPR groups "2 * ${groups}")
      math(EXPR count "(${count} + 1) / 2")
    endwhile()
    string(MD5 hash ${source})
    string(SUBSTRING ${hash} 0 4 digits)
    math(EXPR group "0x${digits} % ${groups}")
    set_source_files_properties(${root}/${source} PROPERTIES UNITY_GROUP ${room}_${group})
  endforeach()
endfunction()

# The library, in float (dcnn) or double (dcnn_double, for gradient tests, with the headers of programs).
function(dcnn_add_library target)
  add_library(${target} STATIC ${ARGN})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen PRIVATE
    $<BUILD_INTERFACE:nlohmann_json::nlohmann_json> $<LINK_ONLY:OpenMP::OpenMP_CXX> hwy::hwy Sodium::sodium)
  # One file makes threads. Elsewhere OpenMP would only cost time: Clang looks for parallel regions in
  # every function, a quarter of its work.
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/core/parallel.cpp PROPERTIES
    COMPILE_OPTIONS "${OpenMP_CXX_FLAGS}" SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=.*undefined")
    # Clang takes minutes over checks of every access in these unrolled loops. ASan's become calls, all UBSan's go in the largest.
    file(GLOB kernels ${PROJECT_SOURCE_DIR}/src/nn/kernels/*.cpp)
    set_property(SOURCE ${kernels} APPEND PROPERTY COMPILE_OPTIONS -mllvm -asan-instrumentation-with-call-threshold=0)
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/src/nn/kernels/fixed_convolution.cpp
      ${PROJECT_SOURCE_DIR}/src/nn/kernels/pair_convolution.cpp APPEND PROPERTY COMPILE_OPTIONS -fno-sanitize=undefined)
  endif()
  # Fixed alignment: a consumer compiled with -march=native must agree with us about Eigen's memory.
  # Threads are ours alone, in fixed pieces: Eigen's own would make results depend on their number.
  set(disabled ${DCNN_DISABLED_TARGETS})
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    # Kernels keep arrays of vectors, so their length must be known: on ARM that is NEON.
    string(APPEND disabled "|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV")
  elseif(NOT DCNN_DISABLED_TARGETS MATCHES "HWY_AVX3([|]|$)")
    target_compile_definitions(${target} PRIVATE DCNN_WITH_VNNI)  # nn/kernels/pair_convolution.cpp
  endif()
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=16 EIGEN_DONT_PARALLELIZE
    PRIVATE DCNN_VERSION="${PROJECT_VERSION}" "HWY_DISABLED_TARGETS=(${disabled})")
  target_compile_features(${target} PUBLIC cxx_std_20)
  if(TARGET dcnn_program_headers)
    dcnn_compile_options(${target} FROM dcnn_program_headers)
  else()
    dcnn_compile_options(${target})
  endif()
  if(DCNN_UNITE_ROOMS)
    dcnn_unite_rooms(${target} ${PROJECT_SOURCE_DIR}/src)
  endif()
endfunction()
