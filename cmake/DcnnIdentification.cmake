# Libraries that identification uses where they are: urdfdom reads an arm's URDF, and in tests orocos-kdl and
# libsdformat check what is computed and written.
find_path(DCNN_URDFDOM_HEADER_DIR urdf_parser/urdf_parser.h)
find_library(DCNN_URDFDOM_LIBRARY urdfdom_model)
mark_as_advanced(DCNN_URDFDOM_HEADER_DIR DCNN_URDFDOM_LIBRARY)

# The library's side: the one file that reads a URDF.
function(dcnn_add_urdf target)
  if(NOT DCNN_URDFDOM_HEADER_DIR OR NOT DCNN_URDFDOM_LIBRARY)
    message(STATUS "dcnn-identify: without --urdf; install liburdfdom-dev for it")
    return()
  endif()
  target_link_libraries(${target} PRIVATE ${DCNN_URDFDOM_LIBRARY})
  set_property(SOURCE ${PROJECT_SOURCE_DIR}/src/identification/arm_urdf.cpp APPEND PROPERTY
    COMPILE_DEFINITIONS DCNN_WITH_URDFDOM)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/identification/arm_urdf.cpp PROPERTIES
    SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# The tests' side: independent readers of what is exported, and another implementation of an arm's dynamics.
function(dcnn_add_oracles target)
  set(payload ${PROJECT_SOURCE_DIR}/tests/identification/payload_test.cpp)
  set(arm ${PROJECT_SOURCE_DIR}/tests/identification/chain_kdl_test.cpp)
  if(DCNN_URDFDOM_HEADER_DIR AND DCNN_URDFDOM_LIBRARY)
    target_link_libraries(${target} PRIVATE ${DCNN_URDFDOM_LIBRARY})
    set_property(SOURCE ${payload} APPEND PROPERTY COMPILE_DEFINITIONS DCNN_WITH_URDFDOM)
  endif()
  find_package(sdformat12 QUIET)
  if(sdformat12_FOUND)
    target_link_libraries(${target} PRIVATE sdformat12::sdformat12)
    set_property(SOURCE ${payload} APPEND PROPERTY COMPILE_DEFINITIONS DCNN_WITH_SDFORMAT)
  endif()
  find_library(DCNN_KDL_LIBRARY orocos-kdl)
  find_path(DCNN_KDL_HEADER_DIR kdl/chainidsolver_recursive_newton_euler.hpp)
  mark_as_advanced(DCNN_KDL_LIBRARY DCNN_KDL_HEADER_DIR)
  if(DCNN_KDL_LIBRARY AND DCNN_KDL_HEADER_DIR)
    target_link_libraries(${target} PRIVATE ${DCNN_KDL_LIBRARY})
    set_property(SOURCE ${arm} APPEND PROPERTY COMPILE_DEFINITIONS DCNN_WITH_KDL)
  endif()
  set_source_files_properties(${payload} ${arm} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
