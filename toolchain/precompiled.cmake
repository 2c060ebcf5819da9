# Libraries whose headers take longer to read than our own sources take to compile are read once, in one precompiled
# header for each set of libraries. A source still includes what it uses: the preset "clang" compiles without these.
# stiction_precompiled(NAME LIBRARY...): the header toolchain/precompiled/NAME.hpp, which sees these libraries.
function(stiction_precompiled name)
  set(source ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Compiled for the precompiled header only.\n")
  add_library(stiction_precompiled_${name} OBJECT ${source})
  target_include_directories(stiction_precompiled_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(stiction_precompiled_${name} PRIVATE ${ARGN})
  target_precompile_headers(stiction_precompiled_${name} PRIVATE ${PROJECT_SOURCE_DIR}/toolchain/precompiled/${name}.hpp)
endfunction()
# stiction_reads(TARGET NAME): the target's sources begin with that header. Joined, a programme's commands are so few
# units that they read CLI11 in less time than its header takes to be made.
function(stiction_reads target name)
  if((STICTION_JOIN OR NOT STICTION_DESK) AND name STREQUAL "commands")
    set(name standard)
  endif()
  target_precompile_headers(${target} REUSE_FROM stiction_precompiled_${name})
endfunction()

stiction_precompiled(standard fmt::fmt)
if(STICTION_DESK)
  stiction_precompiled(desk fmt::fmt nlohmann_json::nlohmann_json Eigen3::Eigen)
endif()
if(STICTION_DESK AND NOT STICTION_JOIN)
  stiction_precompiled(commands fmt::fmt nlohmann_json::nlohmann_json Eigen3::Eigen CLI11::CLI11)
endif()
