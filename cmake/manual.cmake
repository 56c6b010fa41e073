# Makes the manual pages: that of portcullis from its template, one a subcommand from its --help by help2man.
# usage: cmake -DPORTCULLIS=FILE -DHELP2MAN=FILE -DTEMPLATE=FILE -DVERSION=V -DFROM_BIN=DIR -DOUT=DIR -P manual.cmake
cmake_minimum_required(VERSION 3.25)
set(ENV{LC_ALL} C)
set(ENV{ARGP_HELP_FMT} "opt-doc-col=60,rmargin=200") # room for the longest option: help2man looks for the space behind it
get_filename_component(folder ${PORTCULLIS} DIRECTORY)
set(ENV{PATH} "${folder}:$ENV{PATH}") # help2man writes the command as it is called
string(TIMESTAMP DATE "%Y-%m-%d" UTC) # heeds SOURCE_DATE_EPOCH

execute_process(COMMAND portcullis --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n  [a-z-]+ +[^\n]+" lines "${help}")
if(NOT lines)
  message(FATAL_ERROR "portcullis --help lists no command")
endif()
file(REMOVE_RECURSE ${OUT}/man1)
file(MAKE_DIRECTORY ${OUT}/man1)
set(pages)
foreach(line IN LISTS lines)
  string(REGEX MATCH "\n  ([a-z-]+) +([^\n]+)" line "${line}")
  set(name ${CMAKE_MATCH_1})
  set(summary "${CMAKE_MATCH_2}")
  execute_process(COMMAND ${HELP2MAN} --no-info --section 1 "--name=${summary}" "--version-string=${VERSION}" "portcullis ${name}"
    OUTPUT_VARIABLE page COMMAND_ERROR_IS_FATAL ANY)
  string(TOUPPER ${name} upper)
  string(REGEX REPLACE "\n\\.TH [^\n]*" "\n.TH PORTCULLIS-${upper} 1 \"${DATE}\" \"portcullis ${VERSION}\" \"User Commands\"" page "${page}")
  string(REPLACE "\nportcullis ${name} \\-" "\nportcullis-${name} \\-" page "${page}")
  string(APPEND page ".SH \"SEE ALSO\"\n.BR portcullis (1)\n")
  file(WRITE ${OUT}/man1/portcullis-${name}.1 "${page}")
  string(REPLACE "-" "\\-" command "${name}")
  string(REPLACE "-" "\\-" text "${summary}")
  string(APPEND COMMANDS ".TP\n.BR portcullis\\-${command} (1)\n${text}\n")
  list(APPEND pages ".BR portcullis\\-${command} (1)")
endforeach()
list(JOIN pages ",\n" SEE_ALSO)
configure_file(${TEMPLATE} ${OUT}/man1/portcullis.1 @ONLY)
