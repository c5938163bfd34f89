# Writes FILE: the texts of PARTS as C++ strings, in that order; styles and scripts are joined, each under its name.
cmake_minimum_required(VERSION 3.22)
set(page "")
set(styles "")
set(scripts "")
foreach(part IN LISTS PARTS)
  file(READ "${part}" text)
  # Compilers limit the length of one literal; literals that stand side by side are one string.
  set(literal "R\"page_part(${text})page_part\"\n")
  if(part MATCHES "\\.css$")
    string(APPEND styles "${literal}")
  elseif(part MATCHES "\\.js$")
    string(APPEND scripts "${literal}")
  else()
    string(APPEND page "${literal}")
  endif()
endforeach()
file(WRITE "${FILE}" "// Made from the files in libs/report/page.\n#include \"page_text.h\"\n\nnamespace roomgraph {\n\n"
     "const std::string_view kPageText =\n${page};\nconst std::string_view kPageStyles =\n${styles};\n"
     "const std::string_view kPageScripts =\n${scripts};\n\n}  // namespace roomgraph\n")
