# The manual pages, made where help2man is and the executable runs here. A page too few is no reason to fail a build.
find_program(PORTCULLIS_HELP2MAN help2man)
if(NOT PORTCULLIS_HELP2MAN OR CMAKE_CROSSCOMPILING OR PORTCULLIS_SANITIZE)
  message(STATUS "No manual pages: no help2man, another machine's build, or sanitizers")
  return()
endif()
set(manual ${PROJECT_BINARY_DIR}/manual)
file(RELATIVE_PATH from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/portcullis)
add_custom_command(OUTPUT ${manual}/man1/portcullis.1
  COMMAND ${CMAKE_COMMAND} -DPORTCULLIS=$<TARGET_FILE:portcullis> -DHELP2MAN=${PORTCULLIS_HELP2MAN} -DVERSION=${PROJECT_VERSION}
    -DTEMPLATE=${PROJECT_SOURCE_DIR}/packaging/portcullis.1.in -DFROM_BIN=${from_bin} -DOUT=${manual} -P ${CMAKE_CURRENT_LIST_DIR}/manual.cmake
  DEPENDS portcullis ${CMAKE_CURRENT_LIST_DIR}/manual.cmake ${PROJECT_SOURCE_DIR}/packaging/portcullis.1.in VERBATIM)
add_custom_target(manual ALL DEPENDS ${manual}/man1/portcullis.1)
install(DIRECTORY ${manual}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT runtime OPTIONAL)
