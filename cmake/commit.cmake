# SPDX-License-Identifier: BSD-3-Clause
# Writes OUTPUT, which defines TESSERA_COMMIT, if the commit of SOURCE has changed: run at each build, so that a program
# reports the commit from which it was built, and nothing is recompiled while that stays the same.
set(commit unknown) # if the sources are not in a repository
find_program(git git)
if(git)
  # safe.directory: the sources may belong to another user, for example in containers.
  execute_process(COMMAND ${git} -c safe.directory=* -C ${SOURCE} describe --always --dirty --abbrev=8 --exclude=*
                  OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE result ERROR_QUIET)
  # A repository around an unpacked archive is not the repository of the sources.
  if(result EQUAL 0 AND EXISTS ${SOURCE}/.git)
    set(commit ${found})
  endif()
elseif(EXISTS ${SOURCE}/.git/HEAD) # no git here: local changes cannot be detected
  file(STRINGS ${SOURCE}/.git/HEAD found LIMIT_COUNT 1)
  if(found MATCHES "^ref: (.+)$")
    set(branch ${CMAKE_MATCH_1})
    set(found)
    if(EXISTS ${SOURCE}/.git/${branch})
      file(STRINGS ${SOURCE}/.git/${branch} found LIMIT_COUNT 1)
    elseif(EXISTS ${SOURCE}/.git/packed-refs)
      file(STRINGS ${SOURCE}/.git/packed-refs found LIMIT_COUNT 1 REGEX " ${branch}$")
    endif()
  endif()
  if(found MATCHES "^[0-9a-f]+")
    string(SUBSTRING ${found} 0 8 commit)
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define TESSERA_COMMIT \"${commit}\"\n")
