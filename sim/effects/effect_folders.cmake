# The tables of effects are made from the names of their folders, as sources of whoever calls these functions. Both are
# in a library of the product; a programme that compiles tables of its own is linked with those, since the linker takes
# a programme's object before a library's.

# stiction_effect_folders(VARIABLE PARENT): the folders below PARENT that have a descriptor.cpp, also those to come, from
# the project's root.
function(stiction_effect_folders variable parent)
  file(GLOB descriptors CONFIGURE_DEPENDS ${parent}/*/descriptor.cpp)
  set(folders "")
  foreach(descriptor IN LISTS descriptors)
    cmake_path(GET descriptor PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    list(APPEND folders ${folder})
  endforeach()
  set(${variable} ${folders} PARENT_SCOPE)
endfunction()

set(stiction_effect_table_head "// Made by CMake (sim/effects/effect_folders.cmake) from the names of folders.\n#include <array>\n\n")

# stiction_law_table(VARIABLE FOLDER...): a source with sim::effect_folders(), of each folder's descriptor.
function(stiction_law_table variable)
  set(declared "")
  set(rows "")
  foreach(folder IN LISTS ARGN)
    cmake_path(GET folder FILENAME name)
    string(APPEND declared "EffectDescriptor ${name}();\n")
    string(APPEND rows "      EffectFolder{effects::${name}, \"${folder}\"},\n")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/effect_folders.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "${stiction_effect_table_head}#include \"sim/effects/effect_table.hpp\"

namespace stiction::sim {
namespace effects {
${declared}}  // namespace effects

std::span<const EffectFolder> effect_folders() {
  static constexpr std::array folders{
${rows}  };
  return folders;
}

}  // namespace stiction::sim
")
  stiction_alone(${source})
  set(${variable} ${source} PARENT_SCOPE)
endfunction()

# stiction_regressor_table(VARIABLE FOLDER...): a source with host::regressor_folders(), of those that have a
# regressor.cpp.
function(stiction_regressor_table variable)
  set(declared "")
  set(rows "")
  foreach(folder IN LISTS ARGN)
    if(EXISTS ${PROJECT_SOURCE_DIR}/${folder}/regressor.cpp)
      cmake_path(GET folder FILENAME name)
      string(APPEND declared "namespace ${name} {\nextern const EffectRegressor regressor;\n}\n")
      string(APPEND rows "      RegressorFolder{\"${name}\", &effects::${name}::regressor},\n")
    endif()
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/regressor_folders.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "${stiction_effect_table_head}#include \"host/diagnose/classes/effect_regressor.hpp\"

namespace stiction::host {
namespace effects {
${declared}}  // namespace effects

std::span<const RegressorFolder> regressor_folders() {
  static constexpr std::array folders{
${rows}  };
  return folders;
}

}  // namespace stiction::host
")
  stiction_alone(${source})
  set(${variable} ${source} PARENT_SCOPE)
endfunction()
