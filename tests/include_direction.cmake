cmake_policy(VERSION 3.25)
# Fails where a file includes a room above its own, or a third party outside its room.
# cmake -DSOURCE_DIR=… -P include_direction.cmake

# The rooms of src/ from the top down: a room includes itself and those after it. The names of files right in src/
# stand for themselves.
set(order main cli python hemibake report pictures trade lighting textures terrain bake io fitting model curves reference
          estimators transport tracers surface sampling core)
# Rooms that may not include all below them, and what they may not.
set(forbidden_pairs "cli>python" "estimators>transport" "estimators>tracers")
# The judge shares nothing with the judged.
foreach(room estimators transport tracers sampling)
  list(APPEND forbidden_pairs "reference>${room}")
endforeach()

# Header prefix and the paths in src/ (between commas) whose files may include it. GLM, {fmt} and JSON go everywhere.
set(third_party
  "embree3/:tracers/embree/" "OpenImageIO/:io/" "OpenEXR/:io/" "Imath/:io/" "hdf5:io/" "openssl/:io/" "png.h:io/"
  "zlib.h:io/" "gdal:io/" "cpl_:io/" "ogr_:io/" "ceres/:fitting/" "Eigen/:fitting/" "tbb/:core/" "boost/:core/" "hwy/:tracers/slice/,transport/,terrain/"
  "CLI/:cli/options/")

set(errors "")
file(GLOB_RECURSE sources RELATIVE ${SOURCE_DIR}/src ${SOURCE_DIR}/src/*.h ${SOURCE_DIR}/src/*.cpp)
list(LENGTH sources source_count)
if(source_count EQUAL 0)
  message(FATAL_ERROR "no sources below ${SOURCE_DIR}/src")
endif()
foreach(source ${sources})
  string(REGEX MATCH "^[^/.]+" room ${source})
  list(FIND order ${room} rank)
  if(rank EQUAL -1)
    string(APPEND errors "src/${source}: '${room}' is no room of the list\n")
    continue()
  endif()
  file(STRINGS ${SOURCE_DIR}/src/${source} includes REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
  foreach(include ${includes})
    string(REGEX REPLACE ".*[<\"]([^>\"]+)[>\"].*" "\\1" header ${include})
    # By its file: "curves/…" is ours, <png.h> and <hdf5.h> are not.
    if(EXISTS ${SOURCE_DIR}/src/${header})
      string(REGEX MATCH "^[^/.]+" target ${header})
      list(FIND order "${target}" target_rank)
      if(target_rank LESS rank OR "${room}>${target}" IN_LIST forbidden_pairs)
        string(APPEND errors "src/${source}: includes ${header}, an arrow the wrong way\n")
      endif()
      continue()
    endif()
    foreach(rule ${third_party})
      string(REPLACE ":" ";" parts ${rule})
      list(GET parts 0 prefix)
      list(GET parts 1 homes)
      string(FIND "${header}" "${prefix}" position)
      if(NOT position EQUAL 0)
        continue()
      endif()
      set(at_home FALSE)
      string(REPLACE "," ";" home_list ${homes})
      foreach(home ${home_list})
        string(FIND "${source}" "${home}" position)
        if(position EQUAL 0)
          set(at_home TRUE)
        endif()
      endforeach()
      if(NOT at_home)
        string(APPEND errors "src/${source}: includes ${header}, which belongs in ${homes}\n")
      endif()
    endforeach()
  endforeach()
endforeach()
if(errors)
  message(FATAL_ERROR "${errors}")
endif()
message(STATUS "${source_count} files, every arrow points down")
