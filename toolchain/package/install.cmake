# cmake --install: the programmes, and the shipped machines where they look for them, ../share/stiction/machines from
# their own folder. Components: programmes; headers and examples are installed by firmware/CMakeLists.txt.
install(TARGETS stictiond stiction-plant RUNTIME DESTINATION bin COMPONENT programmes)
if(STICTION_DESK)
  install(TARGETS stiction RUNTIME DESTINATION bin COMPONENT programmes)
endif()
install(DIRECTORY firmware/machine/shipped/ DESTINATION share/stiction/machines COMPONENT programmes
        FILES_MATCHING PATTERN "*.toml")
if(STICTION_DESK)
  install(DIRECTORY host/sweep/shipped/ DESTINATION share/stiction/sweeps COMPONENT programmes
          FILES_MATCHING PATTERN "*.toml")
endif()
