% The angles of a four-bar linkage, from the triangle that its diagonal makes with coupler and follower.
addpath (fullfile (pwd (), '..', '..', 'adapters', 'octave'));

function found = angles (p)
  % Columns in, columns out: every operation is one of arrays.
  theta = p.theta * pi / 180;
  x = p.ground - p.crank .* cos (theta);
  y = -p.crank .* sin (theta);
  diagonal = hypot (x, y);
  reach = (p.coupler .^ 2 - p.follower .^ 2 - diagonal .^ 2) ./ (2 * p.follower .* diagonal);
  reach(abs (reach) > 1) = NaN;    % the links do not meet: no value
  gamma = atan2 (y, x) + acos (reach);
  beta = atan2 (y + p.follower .* sin (gamma), x + p.follower .* cos (gamma));
  found.angle = gamma * 180 / pi;
  found.transmission = (gamma - beta) * 180 / pi;
end

sensitol_octave (@angles, 'name', 'four-bar linkage', 'version', '1', 'outputs', {'angle', 'transmission'}, ...
  'inputs', {'crank', 'coupler', 'follower', 'ground', 'theta'}, 'units', struct ('theta', 'deg'));
