# Installation and export: find_package(Lacerta) in another project gives lacerta::decoder, lacerta::encoder, lacerta::draco,
# lacerta::gltf and the libraries under them, and lacerta::c; find_package(Lacerta COMPONENTS c) gives the last alone.
include(CMakePackageConfigHelpers)

set(LACERTA_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Lacerta)
install(DIRECTORY draco_ext/include/ gltf/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT LacertaTargets NAMESPACE lacerta:: DESTINATION ${LACERTA_CMAKE_DIR})
if(TARGET lacerta_c)
  install(EXPORT LacertaCTargets NAMESPACE lacerta:: DESTINATION ${LACERTA_CMAKE_DIR})
endif()
configure_package_config_file(cmake/LacertaConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/LacertaConfig.cmake
  INSTALL_DESTINATION ${LACERTA_CMAKE_DIR})
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/LacertaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/LacertaConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/LacertaConfigVersion.cmake
  DESTINATION ${LACERTA_CMAKE_DIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
