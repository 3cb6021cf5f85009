(* What a rounding is worth: binary64, to nearest, no underflow. *)
From Flocq Require Import Core Relative.
Require Import Reals Lra.
Open Scope R_scope.

Definition rnd := round radix2 (FLT_exp (-1074) 53) ZnearestE.

Lemma a_rounding_is_a_factor : forall x, bpow radix2 (-1022) <= Rabs x ->
  exists e, Rabs e <= / 2 * bpow radix2 (-52) /\ rnd x = x * (1 + e).
Proof. intros x H. apply (relative_error_N_FLT_ex radix2 (-1074) 53 eq_refl (fun x => negb (Z.even x)) x H). Qed.
