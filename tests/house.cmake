cmake_policy(VERSION 3.25)
# Fails where a source is in no CMake list, a line cites a document outside the repository, or README.md is too long.
# cmake -DSOURCE_DIR=… -P house.cmake

set(errors "")

# Explicit lists: a source that no list names would be compiled by nobody.
foreach(folder src tests)
  file(GLOB_RECURSE lists ${SOURCE_DIR}/${folder}/CMakeLists.txt ${SOURCE_DIR}/${folder}/*.cmake)
  set(listed "")
  foreach(list_file ${lists})
    file(READ ${list_file} text)
    # bench/${name}_bench.cpp stands for one file per name.
    string(REGEX MATCHALL "[A-Za-z0-9_/.-]+\\.cpp" names "${text}")
    list(APPEND listed ${names})
  endforeach()
  file(GLOB_RECURSE sources RELATIVE ${SOURCE_DIR}/${folder} ${SOURCE_DIR}/${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "^bench/|node_modules/")
  foreach(source ${sources})
    if(NOT source IN_LIST listed)
      string(APPEND errors "${folder}/${source}: in no list of ${folder}/CMakeLists.txt\n")
    endif()
  endforeach()
endforeach()

# A reader of the repository has no other document.
file(GLOB_RECURSE texts RELATIVE ${SOURCE_DIR}
  ${SOURCE_DIR}/src/* ${SOURCE_DIR}/tests/* ${SOURCE_DIR}/scripts/* ${SOURCE_DIR}/fits/*.md)
list(APPEND texts CMakeLists.txt README.md CHANGELOG.md)
list(FILTER texts EXCLUDE REGEX "node_modules/|__pycache__/")
foreach(text ${texts})
  if(EXISTS ${SOURCE_DIR}/${text})
    file(STRINGS ${SOURCE_DIR}/${text} lines REGEX "(DESIGN|FACTS|STYLE)[.]md")
    list(LENGTH lines count)
    if(count GREATER 0)
      string(APPEND errors "${text}: cites a document outside the repository, lines of that kind: ${count}\n")
    endif()
  endif()
endforeach()

# Characters, not bytes: those that continue a character of UTF-8 (10xxxxxx) are left out.
file(READ ${SOURCE_DIR}/README.md bytes HEX)
string(REGEX MATCHALL ".." bytes "${bytes}")
list(FILTER bytes EXCLUDE REGEX "^[89ab]")
list(LENGTH bytes characters)
if(characters GREATER 10000)
  string(APPEND errors "README.md: ${characters} characters, at most 10000: the rest goes to the folder's README.md\n")
endif()

if(errors)
  message(FATAL_ERROR "${errors}")
endif()
