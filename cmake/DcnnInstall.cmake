# cmake --install, and find_package(dcnn) for those who use the library.
include(CMakePackageConfigHelpers)
install(TARGETS dcnn EXPORT dcnnTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(DIRECTORY include/dcnn DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/dcnn COMPONENT tools)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/dcnn)
install(EXPORT dcnnTargets NAMESPACE dcnn:: DESTINATION ${package_dir} COMPONENT dev)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/dcnnConfig.cmake
"include(CMakeFindDependencyMacro)
list(APPEND CMAKE_MODULE_PATH \${CMAKE_CURRENT_LIST_DIR})
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(OpenMP COMPONENTS CXX)
find_dependency(hwy)
find_dependency(Sodium)
include(\${CMAKE_CURRENT_LIST_DIR}/dcnnTargets.cmake)
")
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/dcnnConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/dcnnConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/dcnnConfigVersion.cmake cmake/FindSodium.cmake
  DESTINATION ${package_dir} COMPONENT dev)
