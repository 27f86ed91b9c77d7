function loadlibrary(library, header, option, name)
% MATLAB's loadlibrary for Octave, as far as dcnn.h needs it: the header must be one that MATLAB reads, functions of numbers,
% texts and pointers to numbers, texts and structures that are never looked into. dcnn_call.c calls them.
  assert(strcmp(option, 'alias'));
  [status, text] = system(['cc -E -P "' header '"']);
  assert(status == 0, 'loadlibrary: cannot preprocess %s', header);
  text = regexprep(text, '\s+', ' ');
  text = regexprep(text, '.*(?=typedef struct dcnn_tool)', '');  % behind the system's headers
  text = regexprep(text, 'enum \{[^}]*\};', '');
  text = regexprep(text, 'typedef struct (\w+) \1;', '');
  functions = struct();
  for declaration = strtrim(strsplit(text, ';'))
    if isempty(declaration{1}), continue; end
    parts = regexp(declaration{1}, '^(.*?)(\w+)\(([^()]*)\)$', 'tokens', 'once');
    assert(~isempty(parts), 'loadlibrary: not a function: %s', declaration{1});
    inputs = strtrim(strsplit(parts{3}, ','));
    if isequal(inputs, {'void'}), inputs = {}; end
    prototype.result = matlab_type(parts{1});
    prototype.inputs = cellfun(@(a) matlab_type(regexprep(a, '\w+$', '')), inputs, 'UniformOutput', false);
    functions.(parts{2}) = prototype;
  end
  global loaded_libraries
  loaded_libraries.(name) = struct('path', library, 'functions', functions);
end

function type = matlab_type(c)
% The name in MATLAB's table of C types for shared libraries.
  c = strtrim(regexprep(strrep(strrep(c, 'const', ''), ' *', '*'), '\s+', ' '));
  known = {'void', '', 'int', 'int32', 'double', 'double', 'size_t', 'uint64', 'char*', 'cstring', ...
           'double*', 'doublePtr', 'int*', 'int32Ptr', 'dcnn_tool*', 'dcnn_toolPtr'};
  at = find(strcmp(known(1:2:end), c));
  assert(~isempty(at), 'loadlibrary: MATLAB has no type for ''%s''', c);
  type = known{2 * at};
end
