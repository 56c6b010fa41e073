# portcullis_add_culler(NAME SOURCES...): the plugin NAME.culler.so, a MODULE target culler_NAME. C11 or C++17, the headers of
# Portcullis, one exported symbol. A culler's NAME is its id: [a-z0-9-].
set(_portcullis_symbols ${CMAKE_CURRENT_LIST_DIR}/culler.map)

function(portcullis_add_culler name)
  if(NOT name MATCHES "^[a-z0-9-]+$")
    message(FATAL_ERROR "portcullis_add_culler: '${name}' is no culler's name; names are of a-z, 0-9 and -")
  elseif(NOT ARGN)
    message(FATAL_ERROR "portcullis_add_culler(${name}): name its source files")
  endif()
  add_library(culler_${name} MODULE ${ARGN})
  target_link_libraries(culler_${name} PRIVATE Portcullis::plugin m)
  # The same bits from every compiler: no fused multiply-add that the source doesn't ask for.
  target_compile_options(culler_${name} PRIVATE -ffp-contract=off)
  target_link_options(culler_${name} PRIVATE "LINKER:--version-script=${_portcullis_symbols}")
  set_target_properties(culler_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} SUFFIX .culler.so
    C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
    C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON LINK_DEPENDS ${_portcullis_symbols})
endfunction()
