function external = predict(model, samples, library, header)
% The external force from MATLAB: the same as predict.c.
%   external = predict('sim.json', samples, 'libdcnn.so.0', '/usr/include/dcnn.h')
% samples: one row "t x y z qw qx qy qz fx fy fz" for each sample; external: one row "fx fy fz" in B for each of them.
if ~libisloaded('dcnn')
  loadlibrary(library, header, 'alias', 'dcnn');
end
message = blanks(256);
[tool, ~, ~, ~, message] = calllib('dcnn', 'dcnn_open', model, [], [], message, numel(message));
if isNull(tool)
  error('dcnn:open', '%s', message);
end
done = onCleanup(@() calllib('dcnn', 'dcnn_close', tool));
external = zeros(size(samples, 1), 3);
for k = 1:size(samples, 1)
  row = samples(k, :);
  own = libpointer('doublePtr', zeros(1, 6));
  out = libpointer('doublePtr', zeros(1, 6));
  calllib('dcnn', 'dcnn_step', tool, row(1), row(2:4), row(5:8), [row(9:11) 0 0 0], own, out);
  external(k, :) = out.Value(1:3);
end
end
