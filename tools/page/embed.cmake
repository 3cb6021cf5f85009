# Writes a header with the page as two arrays of bytes: PAGE_HEAD, which ends where the scene's data stand, and PAGE_TAIL behind
# them.  cmake -D FOLDER=DIR -D PARTS=page.html;page.css;FIRST.js;... -D OUT=HEADER -P embed.cmake
#
# page.html has the places: @STYLE@, @DATA@ and @SCRIPTS@. The scripts are one script in the page, in the order of PARTS.
set(scripts "")
foreach(part IN LISTS PARTS)
  file(READ "${FOLDER}/${part}" text)
  if(part MATCHES "\\.html$")
    set(page "${text}")
  elseif(part MATCHES "\\.css$")
    set(style "${text}")
  else()
    string(APPEND scripts "${text}")
  endif()
endforeach()
string(FIND "${page}" "@DATA@" data)
string(SUBSTRING "${page}" 0 ${data} head)
math(EXPR behind "${data} + 6")
string(SUBSTRING "${page}" ${behind} -1 tail)
string(REPLACE "@STYLE@" "${style}" head "${head}")
string(REPLACE "@SCRIPTS@" "${scripts}" tail "${tail}")

# In hexadecimal nothing is special to CMake or to C.
function(make_array name text result)
  string(HEX "${text}" digits)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${digits}")
  string(REGEX REPLACE "(.....................................................................................)" "\\1\n" bytes "${bytes}")
  set(${result} "static const unsigned char ${name}[] = {\n${bytes}\n};\n" PARENT_SCOPE)
endfunction()
make_array(PAGE_HEAD "${head}" head_array)
make_array(PAGE_TAIL "${tail}" tail_array)
file(WRITE "${OUT}" "/* Made from tools/page by embed.cmake. */\n${head_array}${tail_array}")
