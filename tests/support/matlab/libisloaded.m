function loaded = libisloaded(name)
  global loaded_libraries
  loaded = isfield(loaded_libraries, name);
end
