function sensitol_octave (model, varargin)
  % A function handle as model of sensitol: answers on stdin and stdout until stdin ends. See README.md.
  %
  %   sensitol_octave (@(p) struct ('gap', p.a - p.b), 'name', 'gap', 'version', '1')
  %
  % The function takes a struct with a column of values for every dimension and constant, all of one length, and returns a column of
  % that length, or a struct with a column for every characteristic. NaN is "no value"; an error is one of the points that it is about.
  %
  % Options, as name and value:
  %   name, version   who answers; part of what kept answers are known by
  %   outputs         cell array of the characteristics that it offers, so that a misspelt one is refused
  %   inputs          cell array of the dimensions that it takes, so that others are refused
  %   units           struct from dimension to unit: a study that states another one is refused
  %   fields          cell array of pairs: field of the struct, dimension of the study, for names that are no identifiers
  %   window          points that may be sent ahead, and so the longest column (256)
  options = struct ('name', 'model', 'version', '', 'window', 256);
  options.outputs = {};
  options.inputs = {};
  options.units = struct ();
  options.fields = {};
  wire = opened ();
  try
    for k = 1:2:numel (varargin)
      if (k == numel (varargin) || ~is_text (varargin{k}) || ~isfield (options, varargin{k}))
        error ('option %d of sensitol_octave is not known; there are %s', (k + 1) / 2, strjoin (fieldnames (options)', ', '));
      end
      options.(varargin{k}) = varargin{k + 1};
    end
  catch fault
    [~] = next_lines (wire);
    refuse (wire, fault);
    return
  end
  [lines, wire] = next_lines (wire);
  if (isempty (lines))
    return
  end
  try
    session = greeted (lines{1}, options);
  catch fault
    refuse (wire, fault);
    return
  end
  say (wire, ready_line (options));
  lines = lines(2:end);
  while (true)
    if (isempty (lines))
      [lines, wire] = next_lines (wire);
      if (isempty (lines))
        return
      end
    end
    answer (wire, session, model, lines(1:min (end, options.window)));
    lines = lines(min (end, options.window) + 1:end);
  end
end

function refuse (wire, fault)
  say (wire, sprintf ('{"error":%s}\n', jsonencode (fault.message)));
end

function line = ready_line (options)
  line = sprintf ('{"ready":true,"name":%s,"window":%d', jsonencode (options.name), options.window);
  version = options.version;
  if (isnumeric (version))
    version = sprintf ('%.17g', version);
  end
  if (~isempty (version))
    line = sprintf ('%s,"version":%s', line, jsonencode (version));
  end
  line = sprintf ('%s}\n', line);
end

% What one study asks of the model.
function session = greeted (line, options)
  hello = jsondecode (line);
  if (~isfield (hello, 'sensitol') || hello.sensitol ~= 1)
    error ('this adapter speaks version 1 of the protocol');
  end
  optional = as_list (hello, 'optional');
  session.dimensions = as_list (hello, 'dimensions');
  session.characteristics = as_list (hello, 'characteristics');
  [constants, values] = constants_of (hello, line);
  names = [session.dimensions, constants];
  if (~isempty (options.inputs))
    for k = 1:numel (names)
      if (~any (strcmp (names{k}, options.inputs)) && ~any (strcmp (names{k}, optional)))
        error ('no dimension or constant `%s`; there are %s', names{k}, strjoin (options.inputs, ', '));
      end
    end
    for k = 1:numel (options.inputs)
      if (~any (strcmp (options.inputs{k}, names)))
        error ('`%s` is needed and the study does not have it', options.inputs{k});
      end
    end
  end
  units = hello.units;
  for k = 1:numel (session.dimensions)
    if (iscell (units) && is_text (units{k}) && isfield (options.units, session.dimensions{k}))
      own = options.units.(session.dimensions{k});
      if (~strcmp (own, units{k}))
        error ('`%s` is in `%s` in the study and in `%s` here; state one of them otherwise', session.dimensions{k}, units{k}, own);
      end
    end
  end
  for k = 1:numel (session.characteristics)
    if (~isempty (options.outputs) && ~any (strcmp (session.characteristics{k}, options.outputs)))
      error ('no characteristic `%s`; there are %s', session.characteristics{k}, strjoin (options.outputs, ', '));
    end
  end
  session.values = values;
  session.fields = cell (1, numel (names));
  for k = 1:numel (names)
    session.fields{k} = field_of (names{k}, options.fields);
  end
end

function field = field_of (name, pairs)
  field = name;
  for k = 1:2:numel (pairs) - 1
    if (strcmp (pairs{k + 1}, name))
      field = pairs{k};
    end
  end
  if (~isvarname (field))
    error ('`%s` is no name of a field; state one for it: "fields", {"some_name", "%s"}', name, name);
  end
end

% A list of names: jsondecode makes [] of an empty one.
function list = as_list (hello, key)
  list = {};
  if (isfield (hello, key) && ~isempty (hello.(key)))
    list = reshape (cellstr (hello.(key)), 1, []);
  end
end

% Names as the study writes them: jsondecode changes those that are no identifiers.
function [names, values] = constants_of (hello, line)
  names = {};
  values = [];
  if (isfield (hello, 'constants') && isstruct (hello.constants) && ~isempty (fieldnames (hello.constants)))
    values = cellfun (@(value) value, struct2cell (hello.constants))';
    inner = regexp (line, '"constants"\s*:\s*\{([^}]*)\}', 'tokens', 'once');
    pieces = regexp (inner{1}, '"((?:[^"\\]|\\.)*)"\s*:', 'tokens');
    names = cellfun (@(piece) jsondecode (['"' piece{1} '"']), pieces, 'UniformOutput', false);
  end
end

function yes = is_text (value)
  yes = ischar (value) && (isempty (value) || isrow (value));
end

% Answers the requests among these lines.
function answer (wire, session, model, lines)
  ids = zeros (1, 0);
  points = zeros (0, numel (session.dimensions));
  for k = 1:numel (lines)
    request = jsondecode (lines{k});
    if (isfield (request, 'x'))
      ids(end + 1) = request.id;
      points(end + 1, :) = request.x;
    end
  end
  if (isempty (ids))
    return
  end
  try
    text = evaluated (session, model, ids, points);
  catch
    % One bad point must not take the others with it.
    text = '';
    for k = 1:numel (ids)
      try
        text = [text, evaluated(session, model, ids(k), points(k, :))];
      catch fault
        text = [text, sprintf('{"id":%d,"error":%s,"retry":false}\n', ids(k), jsonencode (fault.message))];
      end
    end
  end
  say (wire, text);
end

% The answers to all of these points, by one call of the model.
function text = evaluated (session, model, ids, points)
  count = numel (ids);
  given = struct ();
  for k = 1:numel (session.fields)
    if (k <= size (points, 2))
      given.(session.fields{k}) = points(:, k);
    else
      given.(session.fields{k}) = repmat (session.values(k - size (points, 2)), count, 1);
    end
  end
  found = model (given);
  names = session.characteristics;
  if (~isstruct (found))
    if (numel (names) ~= 1)
      error ('the model returned no struct, and %s are asked for', strjoin (names, ', '));
    end
    found = struct (names{1}, found);
  end
  y = zeros (count, numel (names));
  for k = 1:numel (names)
    if (~isfield (found, names{k}))
      error ('the model returned no `%s`', names{k});
    end
    column = found.(names{k});
    if (~isnumeric (column) || numel (column) ~= count)
      error ('the model returned %d values of `%s` for %d points', numel (column), names{k}, count);
    end
    if (~isreal (column))
      % No value where a root or logarithm left the real numbers.
      outside = imag (column) ~= 0;
      column = real (column);
      column(outside) = NaN;
    end
    y(:, k) = double (column(:));
  end
  parts = cell (1, count);
  for row = 1:count
    parts{row} = one_answer (ids(row), y(row, :), names);
  end
  text = [parts{:}];
end

function text = one_answer (id, y, names)
  if (all (isfinite (y)))
    values = sprintf (',%.17g', y);
    text = sprintf ('{"id":%d,"y":[%s]}\n', id, values(2:end));
    return
  end
  values = cell (1, numel (y));
  reasons = {};
  for k = 1:numel (y)
    if (isfinite (y(k)))
      values{k} = sprintf ('%.17g', y(k));
    else
      values{k} = 'null';
      reasons{end + 1} = sprintf ('%s:"the model returned %f"', jsonencode (names{k}), y(k));
    end
  end
  text = sprintf ('{"id":%d,"y":[%s],"errors":{%s}}\n', id, strjoin (values, ','), strjoin (reasons, ','));
end

% The protocol's descriptors. Octave: whatever the model prints goes to stderr from now on. MATLAB has no such way: the model must
% not print there.
function wire = opened ()
  wire = struct ('in', -1, 'out', 1, 'rest', '');
  if (exist ('OCTAVE_VERSION', 'builtin'))
    wire.in = fopen ('/dev/stdin', 'r');
    wire.out = fopen ('/dev/stdout', 'w');
    if (wire.in < 0 || wire.out < 0)
      error ('this system has no /dev/stdin and /dev/stdout');
    end
    dup2 (stderr, stdout);
  end
end

function say (wire, text)
  fwrite (wire.out, text);
  if (wire.in >= 0)
    fflush (wire.out);
  end
end

% All lines that have arrived, one at the least; none at the end of the input.
function [lines, wire] = next_lines (wire)
  if (wire.in < 0)
    try
      lines = {input('', 's')};
    catch
      lines = {};
    end
    return
  end
  while (~any (wire.rest == newline ()))
    % One byte is waited for; what else is there is taken without waiting. Reading by lines would wait for the line after.
    first = fread (wire.in, 1, 'uint8=>char')';
    if (isempty (first))
      lines = {};
      return
    end
    fcntl (wire.in, F_SETFL, O_NONBLOCK);
    more = fread (wire.in, 2^20, 'uint8=>char')';
    fclear (wire.in);
    fcntl (wire.in, F_SETFL, O_RDONLY);
    wire.rest = [wire.rest, first, more];
  end
  last = find (wire.rest == newline (), 1, 'last');
  lines = strsplit (wire.rest(1:last - 1), newline ());
  wire.rest = wire.rest(last + 1:end);
  lines = lines(~cellfun (@isempty, lines));
  if (isempty (lines))
    [lines, wire] = next_lines (wire);
  end
end
