# What is installed, in two components: runtime (executable, library, plugins, manual pages) and development (headers, CMake
# package, pkg-config files, the library's link name). Nothing installed holds the path of the source, the build or the prefix.
include(CMakePackageConfigHelpers)

set(PORTCULLIS_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Portcullis)
set(made ${PROJECT_BINARY_DIR}/package)
file(STRINGS ${PROJECT_SOURCE_DIR}/api/portcullis/culler.h PORTCULLIS_PLUGIN_ABI REGEX "^#define CULL_ABI ")
string(REGEX REPLACE "^#define CULL_ABI ([0-9]+)u.*" "\\1" PORTCULLIS_PLUGIN_ABI "${PORTCULLIS_PLUGIN_ABI}")
if(NOT PORTCULLIS_PLUGIN_ABI MATCHES "^[0-9]+$")
  message(FATAL_ERROR "no CULL_ABI in culler.h")
endif()

# ---- runtime ----

get_property(plugins GLOBAL PROPERTY PORTCULLIS_PLUGINS)
install(TARGETS portcullis EXPORT PortcullisToolTargets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(TARGETS ${plugins} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/portcullis COMPONENT runtime)
install(TARGETS portcullis_library EXPORT PortcullisHostTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/host/import/scene.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/portcullis COMPONENT runtime)

include(${CMAKE_CURRENT_LIST_DIR}/manual_target.cmake)

# ---- development ----

install(DIRECTORY ${PROJECT_SOURCE_DIR}/api/portcullis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
target_include_directories(portcullis_api INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set_target_properties(portcullis_api PROPERTIES EXPORT_NAME plugin)
set_target_properties(portcullis_library PROPERTIES EXPORT_NAME host)
install(TARGETS portcullis_api EXPORT PortcullisPluginTargets)
foreach(part Plugin Host Tool)
  install(EXPORT Portcullis${part}Targets NAMESPACE Portcullis:: DESTINATION ${PORTCULLIS_CMAKE_DIR} COMPONENT development)
endforeach()

# Before 1.0 each minor version may break what was.
set(compatibility SameMajorVersion)
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(compatibility SameMinorVersion)
endif()
set(PORTCULLIS_PLUGIN_FOLDER ${CMAKE_INSTALL_LIBDIR}/portcullis)
set(PORTCULLIS_HOST_FILE ${CMAKE_INSTALL_LIBDIR}/libportcullis.so.${PROJECT_VERSION})
set(PORTCULLIS_TOOL_FILE ${CMAKE_INSTALL_BINDIR}/portcullis)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/PortcullisConfig.cmake.in ${made}/PortcullisConfig.cmake
  INSTALL_DESTINATION ${PORTCULLIS_CMAKE_DIR} PATH_VARS PORTCULLIS_PLUGIN_FOLDER PORTCULLIS_HOST_FILE PORTCULLIS_TOOL_FILE)
write_basic_package_version_file(${made}/PortcullisConfigVersion.cmake COMPATIBILITY ${compatibility})
install(FILES ${made}/PortcullisConfig.cmake ${made}/PortcullisConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/PortcullisAddCuller.cmake ${CMAKE_CURRENT_LIST_DIR}/culler.map
  DESTINATION ${PORTCULLIS_CMAKE_DIR} COMPONENT development)

file(RELATIVE_PATH PORTCULLIS_PREFIX_FROM_PC ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" PORTCULLIS_PREFIX_FROM_PC "${PORTCULLIS_PREFIX_FROM_PC}")
foreach(name portcullis portcullis-plugin)
  configure_file(${PROJECT_SOURCE_DIR}/host/library/${name}.pc.in ${made}/${name}.pc @ONLY)
  install(FILES ${made}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()
