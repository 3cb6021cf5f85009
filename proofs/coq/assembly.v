(* From the coefficients that are counted on the tapes to the bounds that the code allows for. Lengths of vectors are reals here;
   what is given of them is the triangle inequality, |R| <= 1.015 and the Frobenius norm 1.7407 of an accepted R. *)
Require Import Reals Lra Psatz.
Require Import constants lemmas.
Open Scope R_scope.

Ltac numbers := unfold u, turned_up, turned_down, offset_up, offset_down, raised_up, raised_down, product_up, product_down,
  length_up, length_down, determinant_up, determinant_down,
  difference_error_size_low, difference_error_separation_low, difference_error_length_low,
  lower_projection_low, lower_projection_high, lower_excess_high, lower_error_high, lower_distance_high,
  upper_distance_low, upper_error_low, upper_point_low, bound_LLL_low, bound_ELL_low, bound_EEL_low, bound_EEE_low,
  rigid_defect, rigid_together, rigid, end_up,
  lower_of_segments_least_low, lower_of_segments_least_high, lower_of_segments_size_high, lower_of_segments_separation_high,
  upper_of_segments_distance_low, upper_of_segments_size_low, upper_of_segments_separation_low, difference_x_p0_low, square_xx_low,
  inner_r1_high, limit_innerinner_high in *.

(* Frame::separation, of an offset whose components are rounded once: not below the exact length, nor above it by more than 16u. *)
Lemma separation_is_above : (1 - raised_down) * (1 - offset_down) >= 1.
Proof. numbers. lra. Qed.

Lemma separation_is_not_far_above : (1 + raised_up) * (1 + offset_up) <= 1 + 16 * u.
Proof. numbers. lra. Qed.

(* Frame::difference: first = R1 p, s = first + o, second = R2 q, D = s - second, as computed, by their lengths. e_f and e_s are the
   errors of the products, e_o that of the offset, off the exact one by u of it; a rounded sum errs by u of what it is rounded to.
   sep is Frame::separation, L the computed |D|. The bound has 8u of itself to spare. *)
Lemma difference_is_off_by_no_more : forall rho1 rho2 o s second D e_f e_s e_o e_sum e_D sep L,
  0 <= rho1 -> 0 <= rho2 -> 0 <= o -> 0 <= D -> 0 <= L -> 0 <= s ->
  e_f <= turned_up * (17407 / 10000) * rho1 -> e_s <= turned_up * (17407 / 10000) * rho2 -> e_o <= offset_up * o ->
  e_sum <= u * s -> e_D <= u * D -> s <= D + e_D + second -> second <= (1015 / 1000) * rho2 + e_s ->
  o <= sep -> D <= (1 + 4 * u) * L -> D <= sep * (1 + 4 * u) + (102 / 100) * (rho1 + rho2) ->
  e_f + e_s + e_o + e_sum + e_D <=
  (1 - 8 * u)
  * (difference_error_size_low * (rho1 + rho2) + difference_error_separation_low * sep + difference_error_length_low * L).
Proof. intros. numbers. lra. Qed.

(* certificate::ends. c = U.D/|U| and d = |D| of the computed D, p and l as computed of them; the true distance is at least
   c - x - e for an error e of D that has 8u of itself to spare. *)
Lemma lower_end : forall c d p l x e kp kx ke kl lower,
  0 <= d -> 0 <= x -> 0 <= e -> p - c <= product_up * d -> (1 - length_down) * d <= l ->
  lower_projection_low <= kp <= lower_projection_high -> kx <= lower_excess_high -> ke <= lower_error_high ->
  kl <= lower_distance_high -> lower = kp * p + kx * x + ke * e + kl * l -> 0 < lower -> lower <= c - x - e * (1 - 8 * u).
Proof.
  intros c d p l x e kp kx ke kl lower Hd Hx He Hp Hl Kp Kx Ke Kl E Pos.
  assert (Hl0 : 0 <= l) by (numbers; lra).
  assert (A1 : kx * x <= lower_excess_high * x) by (apply Rmult_le_compat_r; assumption).
  assert (A2 : ke * e <= lower_error_high * e) by (apply Rmult_le_compat_r; assumption).
  assert (A3 : kl * l <= lower_distance_high * l) by (apply Rmult_le_compat_r; assumption).
  assert (P : 0 < kp * p) by (numbers; lra).
  assert (Hkp : 0 < kp) by (numbers; lra).
  assert (Hp0 : 0 < p) by (apply Rmult_lt_reg_l with kp; [assumption|lra]).
  assert (A4 : kp * p <= lower_projection_high * p) by (apply Rmult_le_compat_r; lra).
  numbers. lra.
Qed.

Lemma upper_end : forall d l e q kl ke kq upper, 0 <= d -> 0 <= e -> 0 <= q -> (1 - length_down) * d <= l ->
  upper_distance_low <= kl -> upper_error_low <= ke -> upper_point_low <= kq -> upper = kl * l + ke * e + kq * q ->
  d + e + q <= upper.
Proof.
  intros d l e q kl ke kq upper Hd He Hq Hl Kl Ke Kq E.
  assert (Hl0 : 0 <= l) by (numbers; lra).
  assert (upper_distance_low * l <= kl * l) by (apply Rmult_le_compat_r; assumption).
  assert (upper_error_low * e <= ke * e) by (apply Rmult_le_compat_r; assumption).
  assert (upper_point_low * q <= kq * q) by (apply Rmult_le_compat_r; assumption).
  numbers. lra.
Qed.

(* enclosure::determinant_error: columns no longer than W <= L, each off by at most E; the permanent is at most r W^3, r^2 = 2. *)
Lemma determinant_is_covered : forall W L E r, 0 <= W <= L -> 0 <= E -> 0 <= r -> r * r = 2 ->
  determinant_up * r * (W*W*W) + (3 * (W*W*E) + 6 * (W*E*E) + 3 * (E*E*E)) <=
  bound_LLL_low * (L*L*L) + bound_ELL_low * (E*L*L) + bound_EEL_low * (E*E*L) + bound_EEE_low * (E*E*E).
Proof.
  intros W L E r HW HE Hr H2.
  assert (R : r <= 15/10) by (apply by_squares; lra).
  assert (P2 : 0 <= W*W) by apply square_is_positive. assert (W2 : W*W <= L*L) by (apply Rmult_le_compat; lra).
  assert (W3 : W*W*W <= L*L*L) by (apply Rmult_le_compat; lra). assert (P3 : 0 <= W*W*W) by (apply Rmult_le_pos; lra).
  assert (A : determinant_up * r * (W*W*W) <= bound_LLL_low * (L*L*L)).
  { apply Rle_trans with (bound_LLL_low * (W*W*W)).
    - apply Rmult_le_compat_r; [assumption|]. apply Rle_trans with (determinant_up * (15/10)).
      + apply Rmult_le_compat_l; [numbers; lra|assumption].
      + numbers; lra.
    - apply Rmult_le_compat_l; [numbers; lra|assumption]. }
  assert (B : 3 * (W*W*E) <= bound_ELL_low * (E*L*L)).
  { apply Rle_trans with (3 * (E*L*L)); [assert (E*(W*W) <= E*(L*L)) by (apply Rmult_le_compat_l; lra); lra|].
    apply Rmult_le_compat_r; [apply Rmult_le_pos; [apply Rmult_le_pos|]; lra|numbers; lra]. }
  assert (C : 6 * (W*E*E) <= bound_EEL_low * (E*E*L)).
  { pose proof (square_is_positive E).
    apply Rle_trans with (6 * (E*E*L)); [assert (E*E*W <= E*E*L) by (apply Rmult_le_compat_l; lra); lra|].
    apply Rmult_le_compat_r; [apply Rmult_le_pos; lra|numbers; lra]. }
  assert (D : 3 * (E*E*E) <= bound_EEE_low * (E*E*E)).
  { pose proof (square_is_positive E). apply Rmult_le_compat_r; [apply Rmult_le_pos; lra|numbers; lra]. }
  lra.
Qed.

(* RIGID_DEFECT: the form of the computed entries, and what measuring makes of them (Gappa: 2.5u on the diagonal in lanes, 3.5u in
   plain arithmetic, 2u beside it). *)
Lemma rigid_by_lanes : sqrt 5 * rigid_together + (25/10 + 4) * u <= rigid_defect.
Proof.
  assert (sqrt 5 <= 224/100) by (apply by_squares; [lra|rewrite sqrt_sqrt; lra]).
  assert (sqrt 5 * rigid_together <= 224/100 * rigid_together) by (apply Rmult_le_compat_r; [numbers; lra|assumption]).
  numbers. lra.
Qed.

Lemma rigid_by_entries : 3 * rigid + (35/10 + 4) * u <= rigid_defect.
Proof. numbers. lra. Qed.

(* round::ends_of_segments. A difference D of ends as computed, as in difference_is_off_by_no_more, is off by e; c is its part along
   a unit direction and p the computed one. The offset is off by at most 9/8 u of sep. *)
Lemma lower_end_of_segments : forall rho1 rho2 s second D e_f e_s e_o e_sum e_D e sep c p k ks kd lower,
  0 <= rho1 -> 0 <= rho2 -> 0 <= sep -> 0 <= D -> 0 <= s ->
  e_f <= turned_up * (17407 / 10000) * rho1 -> e_s <= turned_up * (17407 / 10000) * rho2 -> e_o <= (9 / 8) * u * sep ->
  e_sum <= u * s -> e_D <= u * D -> s <= D + e_D + second -> second <= (1015 / 1000) * rho2 + e_s ->
  D <= sep * (1 + 4 * u) + (1016 / 1000) * (rho1 + rho2) -> e <= e_f + e_s + e_o + e_sum + e_D ->
  - D <= c <= D -> - (product_up * D) <= p - c <= product_up * D ->
  lower_of_segments_least_low <= k <= lower_of_segments_least_high -> ks <= lower_of_segments_size_high ->
  kd <= lower_of_segments_separation_high -> lower = k * p + ks * (rho1 + rho2) + kd * sep -> lower <= c - e.
Proof.
  intros rho1 rho2 s second D e_f e_s e_o e_sum e_D e sep c p k ks kd lower H1 H2 Hsep HD Hs Ef Es Eo Esum ED Ss Second Long E C P
    Hk Hks Hkd Lower.
  assert (A1 : ks * (rho1 + rho2) <= lower_of_segments_size_high * (rho1 + rho2)) by (apply Rmult_le_compat_r; lra).
  assert (A2 : kd * sep <= lower_of_segments_separation_high * sep) by (apply Rmult_le_compat_r; assumption).
  assert (A3 : (k - 1) * p <= u * ((1 + product_up) * D)).
  { assert (B : - u <= k - 1 <= u) by (numbers; lra).
    assert (Q : - ((1 + product_up) * D) <= p <= (1 + product_up) * D) by lra.
    assert (U : 0 <= u) by (numbers; lra).
    destruct (Rle_dec 0 p) as [Hp|Hp].
    - apply Rle_trans with (u * p); [apply Rmult_le_compat_r|apply Rmult_le_compat_l]; lra.
    - replace ((k - 1) * p) with ((1 - k) * - p) by ring.
      apply Rle_trans with (u * - p); [apply Rmult_le_compat_r|apply Rmult_le_compat_l]; lra. }
  numbers. lra.
Qed.

(* Points between two ends have errors of ends e_1 and e_2 between those of the ends; seen, tails, ways, what is moved and D are the
   lengths of what is computed, and each sum, product and difference is off by u of that. *)
Lemma upper_end_of_segments : forall rho1 rho2 sep seen tails way1 way2 moved D e_1 e_2 e_o e_seen e_tails e_way1 e_product1 e_moved
  e_way2 e_product2 e_D distance k ks kd upper,
  0 <= rho1 -> 0 <= rho2 -> 0 <= sep -> 0 <= D -> 0 <= distance ->
  e_1 <= end_up * (17407 / 10000) * rho1 -> e_2 <= end_up * (17407 / 10000) * rho2 -> e_o <= (9 / 8) * u * sep ->
  e_seen <= u * seen -> seen <= tails + e_tails + (1016 / 1000) * rho2 ->
  e_tails <= u * tails -> tails <= sep * (1 + 4 * u) + (1016 / 1000) * (rho1 + rho2) ->
  e_way1 <= u * way1 -> e_product1 <= u * way1 -> way1 <= 2 * (1016 / 1000) * rho1 ->
  e_way2 <= u * way2 -> e_product2 <= u * way2 -> way2 <= 2 * (1016 / 1000) * rho2 ->
  e_moved <= u * moved -> moved <= D + e_D + way2 + e_product2 -> e_D <= u * D -> (1 - length_down) * D <= distance ->
  upper_of_segments_distance_low <= k -> upper_of_segments_size_low <= ks -> upper_of_segments_separation_low <= kd ->
  upper = k * distance + ks * (rho1 + rho2) + kd * sep ->
  D + (e_1 + e_2 + e_o + e_seen + e_tails + e_way1 + e_product1 + e_moved + e_way2 + e_product2 + e_D) <= upper.
Proof.
  intros.
  assert (upper_of_segments_distance_low * distance <= k * distance) by (apply Rmult_le_compat_r; assumption).
  assert (upper_of_segments_size_low * (rho1 + rho2) <= ks * (rho1 + rho2)) by (apply Rmult_le_compat_r; lra).
  assert (upper_of_segments_separation_low * sep <= kd * sep) by (apply Rmult_le_compat_r; assumption).
  numbers. lra.
Qed.

(* glance::square_of_rigid: origins q apart, with a square computed as s, and balls whose radii have the sum r, computed as i. Rigid
   rotations leave of a radius the root of 1 - rigid_defect at least. *)
Lemma balls_overlap : forall q s i r limit, 0 <= i <= inner_r1_high * r ->
  difference_x_p0_low * difference_x_p0_low * square_xx_low * (q * q) <= s -> s < limit ->
  limit <= limit_innerinner_high * (i * i) -> q * q < (1 - rigid_defect) * (r * r).
Proof.
  intros q s i r limit Hi Hs H Hl.
  assert (I : i * i <= inner_r1_high * r * (inner_r1_high * r)) by (apply Rmult_le_compat; lra).
  replace (inner_r1_high * r * (inner_r1_high * r)) with (inner_r1_high * inner_r1_high * (r * r)) in I by ring.
  pose proof (square_is_positive r). pose proof (square_is_positive q).
  numbers. lra.
Qed.
