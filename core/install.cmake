# The C++ libraries rtg::core and rtg::config for find_package(rtg), with headers below include/rtg.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/rtg)

foreach(library core files protocol config)
  set_target_properties(rtg_${library} PROPERTIES EXPORT_NAME ${library})
  install(TARGETS rtg_${library} EXPORT rtg ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
install(EXPORT rtg NAMESPACE rtg:: FILE rtgTargets.cmake DESTINATION ${package})
install(DIRECTORY core nodes DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rtg FILES_MATCHING PATTERN "*.hpp")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_file(core/rtgConfig.cmake.in ${PROJECT_BINARY_DIR}/rtgConfig.cmake @ONLY)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/rtgConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/rtgConfig.cmake ${PROJECT_BINARY_DIR}/rtgConfigVersion.cmake DESTINATION ${package})
