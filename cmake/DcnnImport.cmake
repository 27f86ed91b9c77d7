# Libraries of other people's log formats. Each is optional: without it dcnn-import names the package to install.
# The definitions stand on the few files that need them, so that finding a library recompiles no other.
function(dcnn_add_format target name header library package)
  find_path(DCNN_${name}_HEADER_DIR ${header})
  find_library(DCNN_${name}_LIBRARY ${library})
  mark_as_advanced(DCNN_${name}_HEADER_DIR DCNN_${name}_LIBRARY)
  if(NOT DCNN_${name}_HEADER_DIR OR NOT DCNN_${name}_LIBRARY)
    message(STATUS "dcnn-import: without ${library}; install ${package} for it")
    return()
  endif()
  target_link_libraries(${target} PRIVATE ${DCNN_${name}_LIBRARY})
  foreach(source ${ARGN})
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/src/import/${source} APPEND PROPERTY COMPILE_DEFINITIONS DCNN_WITH_${name})
    set_source_files_properties(${PROJECT_SOURCE_DIR}/src/import/${source} PROPERTIES
      SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
endfunction()

function(dcnn_add_formats target)
  dcnn_add_format(${target} ZLIB zlib.h z zlib1g-dev decompress.cpp)
  dcnn_add_format(${target} BZIP2 bzlib.h bz2 libbz2-dev decompress.cpp)
  dcnn_add_format(${target} LZ4 lz4frame.h lz4 liblz4-dev decompress.cpp)
  dcnn_add_format(${target} ZSTD zstd.h zstd libzstd-dev decompress.cpp)
  dcnn_add_format(${target} SQLITE sqlite3.h sqlite3 libsqlite3-dev db3.cpp)
  dcnn_add_format(${target} MATIO matio.h matio libmatio-dev mat.cpp)
  dcnn_add_format(${target} URDFDOM urdf_parser/urdf_parser.h urdfdom_model liburdfdom-dev arm_pose.cpp)
  # Programs that read no logs load none of them.
  target_link_options(${target} INTERFACE LINKER:--as-needed)
endfunction()
