# The recipes of docs/extending.md as sources: the page is the one place of their code.
set(recipes ${CMAKE_BINARY_DIR}/recipes)

# stiction_recipe(SECTION FOLDER): writes the files that a section of the page gives and changes below FOLDER; again
# when the page has changed, or a file that it changes.
function(stiction_recipe section folder)
  set(page docs/extending.md)
  execute_process(COMMAND ${debian_python} -B ${PROJECT_SOURCE_DIR}/tests/docs/extract.py ${PROJECT_SOURCE_DIR} ${page}
                          ${section} ${folder} OUTPUT_VARIABLE files RESULT_VARIABLE status ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${page}, ${section}: ${said}")
  endif()
  set(sources ${PROJECT_SOURCE_DIR}/${page})
  foreach(file IN LISTS files)
    if(EXISTS ${PROJECT_SOURCE_DIR}/${file})
      list(APPEND sources ${PROJECT_SOURCE_DIR}/${file})
    endif()
  endforeach()
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources})
endfunction()

# One tree for what is built together: the law, the backend, the command; the effect in one of its own, which is also
# linked with the laws of the product.
stiction_recipe(a-friction-model ${recipes}/tree)
stiction_recipe(a-backend ${recipes}/tree)
stiction_recipe(a-command ${recipes}/tree)
stiction_recipe(an-effect ${recipes}/effect)
