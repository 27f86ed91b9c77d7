# Debian packages by CPack: dcnn-tools, libdcnn0, libdcnn-dev, dcnn-doc. tools/package builds, checks and tries them.
set(packages dcnn-tools libdcnn0 libdcnn-dev dcnn-doc)
set(components tools runtime dev doc)

# What every Debian package has; CPack alone asks for it.
foreach(package component IN ZIP_LISTS packages components)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES packaging/copyright NOTICE DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES packaging/changelog RENAME changelog.Debian DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES packaging/lintian-overrides RENAME ${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
    COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/dcnn-doc COMPONENT doc EXCLUDE_FROM_ALL)
install(FILES CHANGELOG.md RENAME changelog DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/dcnn-doc COMPONENT doc EXCLUDE_FROM_ALL)
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/dcnn-doc COMPONENT doc EXCLUDE_FROM_ALL)
install(DIRECTORY data/sample DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/dcnn-doc/data COMPONENT doc EXCLUDE_FROM_ALL)
install(FILES data/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/dcnn-doc/data COMPONENT doc EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME dcnn)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VENDOR "The DCNN Toolkit authors")
set(CPACK_PACKAGE_CONTACT "The DCNN Toolkit authors <dcnn-toolkit@users.noreply.github.com>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/PrepareStaging.cmake)

set(CPACK_VERBATIM_VARIABLES ON)  # a description has quotation marks
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/triggers)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "dcnn-doc, nodejs")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "libdcnn0 (= ${PROJECT_VERSION}-1), libeigen3-dev, libhwy-dev, libsodium-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS dcnn-doc)

function(describe component package summary text)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
endfunction()
set(about "The DCNN Toolkit compares a simulator of a robot's tool with logged
motion and force, names the physics that is missing, learns the rest with
physical models and networks, and subtracts the tool's own force online.
")
describe(tools dcnn-tools "identification of a robot tool's dynamics: programs"
  "${about}
These are its programs, \"dcnn VERB\", with manual pages and completions.")
describe(runtime libdcnn0 "identification of a robot tool's dynamics: C library"
  "${about}
This is the library for C: it opens a model file or a corrected simulator,
takes one sample and gives the force, with state and without allocation.")
describe(dev libdcnn-dev "identification of a robot tool's dynamics: development"
  "${about}
Here are the headers for C and C++, the static library for C++ and its
CMake package.")
describe(doc dcnn-doc "identification of a robot tool's dynamics: documents"
  "${about}
Here are its documents, examples and sample recordings.")
include(CPack)
