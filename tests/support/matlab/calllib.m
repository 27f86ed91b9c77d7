function varargout = calllib(name, method, varargin)
% MATLAB's calllib for Octave: the result, then every argument that is a pointer, as the function left it.
  global loaded_libraries
  library = loaded_libraries.(name);
  assert(isfield(library.functions, method), 'calllib: %s has no function %s', name, method);
  prototype = library.functions.(method);
  types = prototype.inputs;
  assert(numel(types) == numel(varargin), 'calllib: %s takes %d arguments', method, numel(types));
  values = varargin;
  for k = 1:numel(types)
    if isa(values{k}, 'libpointer'), values{k} = values{k}.Value; end
    fits = isempty(values{k}) || (strcmp(types{k}, 'cstring') && ischar(values{k})) || ...
           (strcmp(types{k}, 'dcnn_toolPtr') && isa(values{k}, 'uint64')) || ...
           (~any(strcmp(types{k}, {'cstring', 'dcnn_toolPtr'})) && isnumeric(values{k}));
    assert(fits, 'calllib: argument %d of %s is no %s', k, method, types{k});
  end
  outputs = cell(1, 1 + numel(types));
  [outputs{:}] = dcnn_call(library.path, method, values{:});
  if isempty(prototype.result), pointers = {}; else, pointers = outputs(1); end
  for k = 1:numel(types)
    if isa(varargin{k}, 'libpointer'), varargin{k}.Value = outputs{1 + k}; end
    if any(strcmp(types{k}, {'cstring', 'dcnn_toolPtr', 'doublePtr', 'int32Ptr'})), pointers{end + 1} = outputs{1 + k}; end
  end
  varargout = pointers(1:min(end, max(1, nargout)));
end
