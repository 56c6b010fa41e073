# Copies a plugin's folder with one fault put in: cmake -DFROM= -DTO= -DFILE= -DOLD= -DNEW= -P mutate.cmake
# Fails when the place is no longer there, so that a mutant never turns into the healthy plugin unnoticed.
file(COPY ${FROM}/ DESTINATION ${TO})
file(GLOB copies ${TO}/*.[ch])
file(TOUCH ${copies})
file(READ ${TO}/${FILE} text)
string(FIND "${text}" "${OLD}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "${FROM}/${FILE} has no place: ${OLD}")
endif()
string(REPLACE "${OLD}" "${NEW}" text "${text}")
file(WRITE ${TO}/${FILE} "${text}")
